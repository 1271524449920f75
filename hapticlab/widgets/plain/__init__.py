"""The live view of PLAIN WIDGETS, where anywidget does not load: a session goes in, an SVG with sliders and buttons comes out.

``plain_view`` has the widgets, ``plain_letters`` the mathematics in letters that an SVG sets by itself.
"""
