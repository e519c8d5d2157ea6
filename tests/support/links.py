#!/usr/bin/python3 -Xutf8
"""links.py FOLDER: each link, anchor and picture of the HTML in a folder that leads nowhere, a line each, and pages that nothing
leads to from index.html"""
import html.parser
import os
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, file):
        super().__init__()
        self.ids, self.links, self.faults = set(), [], []
        with open(file) as text:
            self.feed(text.read())

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if 'id' in attrs:
            if attrs['id'] in self.ids:
                self.faults.append(f'two places have the id {attrs["id"]}')
            self.ids.add(attrs['id'])
        if tag == 'img' and 'alt' not in attrs:
            self.faults.append(f'{attrs.get("src")}: a picture without a text')
        self.links += [attrs[a] for a in ('href', 'src') if a in attrs]


root = os.path.abspath(sys.argv[1])
pages = {os.path.join(d, f): Page(os.path.join(d, f)) for d, _, files in os.walk(root) for f in files if f.endswith('.html')}
reached, todo = set(), [os.path.join(root, 'index.html')]
while todo:
    name = todo.pop()
    if name in reached or name not in pages:
        continue
    reached.add(name)
    todo += [os.path.normpath(os.path.join(os.path.dirname(name), urllib.parse.unquote(link.split('#')[0]))) for link in pages[name].links]
for name, page in sorted(pages.items()):
    short = os.path.relpath(name, root)
    for fault in page.faults:
        print(f'{short}: {fault}')
    for link in page.links:
        to, _, anchor = link.partition('#')
        if ':' in to.split('/')[0]:
            continue
        file = os.path.normpath(os.path.join(os.path.dirname(name), urllib.parse.unquote(to))) if to else name
        if not os.path.isfile(file) or not file.startswith(root):
            print(f'{short}: {link}: no such file')
        elif anchor and file in pages and urllib.parse.unquote(anchor) not in pages[file].ids:
            print(f'{short}: {link}: no such place')
    if name not in reached:
        print(f'{short}: no page leads here')
