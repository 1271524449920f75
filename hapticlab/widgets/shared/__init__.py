"""A scene as one file that anybody can open: page data in, HTML out. Read share.py, then page_data.py, then page.py."""
