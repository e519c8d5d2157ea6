#!/usr/bin/python3
"""rendered.py FOLDER MANUAL ...: each manual as FOLDER/NAME.SECTION.md, the HTML of mandoc without its classes, which forges show as a page;
and FOLDER/README.md, their list. Links lead to the manuals that are given."""
import html
import re
import subprocess
import sys
from pathlib import Path

SECTIONS = {'1': 'Tools', '3': 'Library', '5': 'Files', '7': 'Concepts'}


def page(manual, there):
    text = subprocess.run(['mandoc', '-T', 'html', '-O', 'fragment,man=%N.%S.md', manual], capture_output=True, text=True, check=True).stdout
    text = re.sub(r'<table class="(head|foot)">.*?</table>\n?', '', text, flags=re.S)
    text = re.sub(r'<a class="permalink" href="[^"]*">(.*?)</a>', r'\1', text, flags=re.S)
    text = re.sub(r'</?(?:section|div)\b[^>]*>\n?', '', text)
    text = re.sub(r' (?:class|style)="[^"]*"', '', text)
    text = re.sub(r'<a href="([^"#:/]+\.md)">(.*?)</a>', lambda m: m[0] if m[1] in there else m[2], text, flags=re.S)
    return re.sub(r'\n\n+', '\n', text)


def main(folder, manuals):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob('*.md'):
        old.unlink()
    there = {Path(m).name + '.md': m for m in manuals}
    for name, manual in there.items():
        (folder / name).write_text(page(manual, there))
    out = '# Manuals\n\nThey are made of the sources in [man](../../man) by `make manuals-keep`; `make install` installs those for `man`.\n'
    for section, title in SECTIONS.items():
        out += f'\n## {title}\n\n'
        for name, manual in sorted(there.items()):
            word, number = name[:-3].rsplit('.', 1)
            if number == section:
                what = re.search(r'^<p>.*?&#x2014;\s*(.*?)</p>', (folder / name).read_text(), re.S | re.M)[1]
                out += f'- [{word}({section})]({name}): {html.unescape(re.sub("<[^>]*>", "", re.sub(chr(10) + " *", " ", what)))}\n'
    (folder / 'README.md').write_text(out)


if __name__ == '__main__':
    if len(sys.argv) < 3:
        sys.exit('usage: rendered.py FOLDER MANUAL ...')
    main(sys.argv[1], sys.argv[2:])
