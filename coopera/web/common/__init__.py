"""What all pages share: the door (who may come in), the look, the templates, the files, and the server.

A kind of page makes `Pages` over its own folder, a list of routes, and `make_app` of both; `serve` shows it.
"""

from coopera.web.common.app import fields, make_app, paths_of
from coopera.web.common.door import Door
from coopera.web.common.pages import Pages
from coopera.web.common.serving import Served, serve, served

__all__ = ["Door", "Pages", "Served", "fields", "make_app", "paths_of", "serve", "served"]
