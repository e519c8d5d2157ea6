#!/usr/bin/python3 -Xutf8
"""make.py OUT: the drawings of the manuals and the site, as SVG in the folder OUT, the same bytes each time"""
import pathlib
import sys

import mechanics
import scene
import tools

DRAWINGS = {name: function for module in (mechanics, scene, tools) for name, function in vars(module).items()
            if callable(function) and getattr(function, '__module__', '') == module.__name__}

out = pathlib.Path(sys.argv[1])
out.mkdir(parents=True, exist_ok=True)
for name, function in DRAWINGS.items():
    (out / (name + '.svg')).write_text(function().text())
