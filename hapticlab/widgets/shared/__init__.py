"""A scene as one file that anybody can open: a scene and a paddle in, HTML out.

Read share.py, then page_data.py (what the page computes with), page.py and document.py (how it becomes one file); around.py has
what stands around the view: equations.py, and the code to copy, code.py and scene_code.py.
"""
