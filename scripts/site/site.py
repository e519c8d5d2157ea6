#!/usr/bin/python3 -Xutf8
"""site.py OUT MANUAL ...: the site, static HTML in the folder OUT, of the Markdown pages, the manuals and the recipes.

A page is where its source is: docs/wall/README.md becomes OUT/docs/wall/index.html, man/nsd-gen.1 OUT/man/nsd-gen.1.html.
Files that pages link to are copied. A link to a file that does not exist ends the program with status 65, and OUT stays as
it was. In a manual a comment .\\" drawing NAME: CAPTION puts docs/drawings/NAME.svg below the heading before it."""
import concurrent.futures
import html
import json
import os
import posixpath as path
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
TOP = HERE.parent.parent
TOOLS = {'cmark-gfm': 'cmark-gfm', 'mandoc': 'mandoc'}  # a program and its Debian package
# The navigation: a source and its name there
NAVIGATION = [
    ('Use', [('README.md', 'Start'), ('INSTALL.md', 'Installation'), ('man/nsd-tutorial.7', 'Tutorial'),
             ('cookbook/README.md', 'Cookbook'), ('docs/drawings/README.md', 'Drawings'), ('man', 'Manuals')]),
    ('Evidence', [('docs/gallery/README.md', 'Gallery'), ('docs/paper/README.md', 'Paper'),
                  ('docs/powder/README.md', 'Powder'), ('docs/forces/README.md', 'Forces'),
                  ('docs/peers/README.md', 'Peers'), ('docs/wall/README.md', 'Large piles'),
                  ('docs/scale/README.md', 'Scale'), ('docs/breakage/README.md', 'Breakage'),
                  ('bench/README.md', 'Benchmarks')]),
    ('Project', [('LIMITATIONS.md', 'Limitations'), ('CHANGELOG.md', 'Changes'), ('CONTRIBUTING.md', 'Contributing'),
                 ('lib/README.md', 'Library')])]
SECTIONS = [('7', 'Concepts, tutorial, recipes'), ('1', 'Programs'), ('5', 'Scenes and documents'), ('3', 'The C library')]
VOID = re.compile(r'<(?:br|img|hr|input|col|meta|link)\b|<!|/>$')


def run(command, text=''):
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True, cwd=TOP).stdout


def plain(fragment):
    """The text of HTML"""
    return html.unescape(re.sub(r'\s+', ' ', re.sub(r'<[^>]*>', '', fragment))).strip()


class Site:
    def __init__(self, out, manuals):
        self.out = out
        self.manuals = {path.basename(m): m for m in manuals}  # nsd-gen.1: where its source is
        self.recipes = sorted(path.dirname(a) for a in self.find('cookbook/*/about'))
        texts = [f for g in ('*.md', 'docs/*/README.md', 'bench/README.md', 'bench/results/*/*.md', 'lib/README.md', 'tests/README.md')
                 for f in self.find(g) if f != 'docs/manual/README.md']
        self.page = {f: re.sub(r'README\.md$', 'index.md', f)[:-3] + '.html' for f in texts}
        self.page |= {'man/' + m: f'man/{m}.html' for m in self.manuals}
        self.page |= {f'docs/manual/{m}.md': f'man/{m}.html' for m in self.manuals}  # as the repository has them
        self.page |= {r: r + '.html' for r in self.recipes}
        self.page |= {'cookbook/README.md': 'cookbook/index.html', 'man': 'man/index.html', 'docs/manual/README.md': 'man/index.html'}
        self.page |= {path.dirname(f): p for f, p in self.page.items() if f.endswith('/README.md')}
        self.folders = []  # that pages link to, and that have no page of their own
        self.index = []    # of the search: page, anchor, title, heading, text
        self.dead = [f'the navigation: {s}' for _, pages in NAVIGATION for s, _ in pages if s not in self.page]

    @staticmethod
    def find(pattern):
        return sorted(str(f.relative_to(TOP)) for f in TOP.glob(pattern))

    # ---- links ----

    def target(self, source, link):
        """Where a link of a source leads: the page or the copy of a file, from the page of the source"""
        name, hash_, anchor = link.partition('#')
        if not name or re.match(r'[a-z]+:', name):
            return link
        name = path.normpath(path.join(source if source in self.recipes else path.dirname(source), html.unescape(name)))
        if name not in self.page:
            if (TOP / name).is_dir():
                self.page[name] = name + '/index.html'
                self.folders.append(name)
            elif (TOP / name).is_file():
                self.copy(name)
            else:
                self.dead.append(f'{source}: {link}')
                return link
        return self.relative(source, self.page.get(name, name)) + hash_ + anchor

    def relative(self, source, name):
        return path.relpath(name, path.dirname(self.page[source]) or '.')

    def copy(self, name):
        (self.out / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(TOP / name, self.out / name)

    def linked(self, source, body):
        """Links lead to pages; names of manuals and of pages become links"""
        body = re.sub(r'(?<=[ <])(href|src)="([^"]*)"', lambda m: f'{m[1]}="{html.escape(self.target(source, m[2]))}"', body)
        inside, parts = [], re.split(r'(<[^>]*>)', body)
        for k, part in enumerate(parts):
            if part.startswith('</'):
                if inside:
                    inside.pop()
            elif part.startswith('<'):
                if not VOID.search(part):
                    inside.append(part)
            elif not any(re.match(r'<(a|h[1-6]|pre|svg|title)\b', t) for t in inside):
                parts[k] = re.sub(r'\b(nsd(?:-[a-z]+)?)\(([1357])\)', lambda m: self.manual_link(source, m), part)
                name = html.unescape(part).strip('/')
                name = 'cookbook/' + name if source == 'man/nsd-cookbook.7' and '/' not in name else name
                if inside and 'class="Pa"' in inside[-1] and name in self.page:
                    parts[k] = f'<a href="{self.relative(source, self.page[name])}">{part}</a>'
        return ''.join(parts)

    def manual_link(self, source, m):
        page = self.page.get(f'man/{m[1]}.{m[2]}')
        return f'<a href="{self.relative(source, page)}">{m[0]}</a>' if page and page != self.page[source] else m[0]

    # ---- a page ----

    def write(self, source, title, body):
        ids = set(re.findall(r'\bid="([^"]*)"', body))

        def named(m):  # a heading of Markdown gets the anchor that GitHub gives it
            if ' id=' in m[2]:
                return m[0]
            name = stem = re.sub(r'[^\w\- ]', '', plain(m[3]).lower()).replace(' ', '-')
            k = 0
            while name in ids:
                k += 1
                name = f'{stem}-{k}'
            ids.add(name)
            return f'<h{m[1]} id="{name}"{m[2]}>{m[3]}</h{m[1]}>'
        body = re.sub(r'<h([1-4])([^>]*)>(.*?)</h\1>', named, body, flags=re.S)
        body = self.linked(source, body)
        body = re.sub(r'<table\b(?: class="([\w-]*)")?.*?</table>(?:\s*<br/>)?', lambda m: f'<div class="wide {m[1] or ""}">{m[0]}</div>', body, flags=re.S)
        body = re.sub(r'(?<!">)(<img src="([^"]*)"[^>]*>)', r'<a href="\2">\1</a>', body)  # a telephone shows it larger
        headings = [(int(h[0]), h[1], plain(h[2])) for h in re.findall(r'<h([1-4])[^>]*? id="([^"]*)"[^>]*>(.*?)</h\1>', body, flags=re.S)]
        if source != 'man/nsd-cookbook.7':  # each recipe has its own page
            self.remember(source, title, body)
        page = (HERE / 'page.html').read_text()
        for name, value in (('title', html.escape(title)), ('root', path.relpath('.', path.dirname(self.page[source]) or '.')),
                            ('navigation', self.navigation(source)), ('contents', self.contents(headings)), ('body', body)):
            page = page.replace(f'@{name}@', value)
        to = self.out / self.page[source]
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(page)

    def navigation(self, source):
        text = ''
        for group, pages in NAVIGATION:
            text += f'<div><b>{group}</b>'
            for s, name in (p for p in pages if p[0] in self.page):
                here = ' class="here"' if self.page[s] == self.page[source] else ''
                text += f'<a href="{self.relative(source, self.page[s])}"{here}>{html.escape(name)}</a>'
            text += '</div>'
        return text

    @staticmethod
    def contents(headings):
        """The list of headings, (level, anchor, text), without the title"""
        if len(headings) < 4:
            return ''
        titled = [level for level, _, _ in headings].count(1) == 1
        rows = ''.join(f'<li class="level{level}"><a href="#{a}">{html.escape(text)}</a></li>'
                       for level, a, text in headings[titled:] if level < 4)
        return f'<details class="contents" open><summary>Contents</summary><ul>{rows}</ul></details>'

    def remember(self, source, title, body):
        """The text of each section, option and key for the search"""
        parts = re.split(r'<(h[1-4]|dt)[^>]*? id="([^"]*)"[^>]*>(.*?)</\1>', body, flags=re.S)
        for anchor, heading, text in zip([''] + parts[2::4], [''] + parts[3::4], parts[0::4]):
            if plain(heading) or plain(text):
                self.index.append([self.page[source] + ('#' + anchor if anchor else ''), title, plain(heading), plain(text)])

    # ---- kinds of pages ----

    def text_page(self, source):
        text = (TOP / source).read_text()
        text = re.sub(r'\A---\n.*?^title: *[\'"]?(.*?)[\'"]?\n.*?^---\n', r'# \1\n', text, flags=re.S | re.M)  # of paper.md
        text = re.sub(r'\[(@[\w:;@ ]+)\]', lambda m: '(' + m[1].replace('@', '').replace(':', ' ') + ')', text)  # citations
        text = re.sub(r'^# References\n*\Z', '# References\n\nare in [paper.bib](paper.bib).\n', text, flags=re.M)
        body = run(['cmark-gfm', '--unsafe', '-e', 'table', '-e', 'strikethrough', '-e', 'autolink'], text)
        body = re.sub(r'<code>([^<]{1,28})</code>', r'<code class="short">\1</code>', body)  # is not broken at its hyphens
        heading = re.search(r'<h1>(.*?)</h1>', body, re.S)
        return source, plain(heading[1]) if heading else source, body

    def manual_page(self, name):
        source = TOP / self.manuals[name]
        text = source.read_text()
        body = run(['mandoc', '-T', 'html', '-O', 'fragment,man=%N.%S', str(source)])
        body = re.sub(r'<a class="In">([^<]*)</a>', r'\1', body)
        body = re.sub(r'<a class="Xr" href="([^"]*)"[^>]*>([^<]*)</a>',
                      lambda m: m[0] if m[1] in self.manuals else m[2], body)
        body = re.sub(r'<table class="(?:head|foot)">.*?</table>', '', body, flags=re.S)
        title = re.sub(r'(.*)\.(.)', r'\1(\2)', name)
        body = re.sub(r'(</?)h([12])\b', lambda m: f'{m[1]}h{int(m[2]) + 1}', body)
        heading, pictures = '', {}
        for m in re.finditer(r'^\.(?:S[hs] (.*)|\\" drawing ([\w-]+): (.*))', text, re.M):
            heading = m[1] or heading
            if m[2]:
                caption = html.escape(m[3])
                pictures[heading] = pictures.get(heading, '') + (f'<figure><img src="../docs/drawings/{m[2]}.svg" alt="{caption}">'
                                                                 f'<figcaption>{caption}</figcaption></figure>')
        for heading, picture in pictures.items():
            words = r'\s+'.join(re.escape(html.escape(w, quote=False)) for w in heading.split())
            body, found = re.subn(rf'<h[23] class="S[hs]"[^>]*>(?:<a[^>]*>)?{words}(?:</a>)?</h[23]>', lambda m: m[0] + picture, body, count=1)
            if not found:
                self.dead.append(f'{self.manuals[name]}: a place for a drawing: {heading}')
        return 'man/' + name, title, f'<h1>{title}</h1>' + body

    def recipe_pictures(self, name):
        """Grains first, which take more bytes than curves"""
        return sorted(self.find(f'docs/cookbook/{name}/*.png'), key=lambda f: -(TOP / f).stat().st_size)

    def recipe_page(self, source):
        title, *lines = (TOP / source / 'about').read_text().splitlines()
        body = run(['cmark-gfm'], f'# {title}\n\n' + '\n'.join(lines))
        for f in self.recipe_pictures(path.basename(source)):
            body += f'<p><img src="../../{f}" alt="{title}: {path.basename(f)}"></p>'
        names = [path.basename(f) for f in self.find(source + '/*')]
        for f in sorted(names, key=lambda n: (n != 'run.sh', not n.startswith('scene'), n)):
            if f not in ('about', 'check.sh') and (TOP / source / f).stat().st_size < 12000:
                text = (TOP / source / f).read_text(errors='replace')
                text = re.sub(r'\bnsd-[a-z]+\b', lambda m: f'<a href="../../man/{m[0]}.1">{m[0]}</a>' if m[0] + '.1' in self.manuals else m[0],
                              html.escape(text, quote=False))
                body += f'<h2>{f}</h2><pre>{text}</pre>'
        return source, title, body + f'<p>Run it: <code>cp -r {source} /tmp; cd /tmp/{path.basename(source)}; bash run.sh</code>.</p>'

    def cookbook_page(self):
        """Recipes by task, as the lines TASK: RECIPE ... of cookbook/tasks; the others at the end; then cookbook/README.md"""
        tasks = [line.split(':') for line in (TOP / 'cookbook/tasks').read_text().splitlines()]
        others = set(self.recipes) - {'cookbook/' + r for _, names in tasks for r in names.split()}
        body = '<h1>The cookbook</h1><p>Recipes by task. Each is a scene and a pipeline that runs within seconds; all of them on one page: nsd-cookbook(7).</p>'
        for task, names in tasks + [['Other recipes', ' '.join(sorted(path.basename(r) for r in others))]]:
            cards = ''
            for r in names.split():
                if f'cookbook/{r}' not in self.recipes:
                    self.dead.append(f'cookbook/tasks: {r}')
                    continue
                pictures = self.recipe_pictures(r)
                title = (TOP / f'cookbook/{r}/about').read_text().splitlines()[0]
                cards += f'<li><a href="{r}">' + (f'<img src="../{pictures[0]}" alt="" loading="lazy">' if pictures else '') + f'<span>{html.escape(title)}</span></a></li>'
            if cards:
                body += f'<h2>{html.escape(task)}</h2><ul class="cards">{cards}</ul>'
        return 'cookbook/README.md', 'Cookbook', body + self.text_page('cookbook/README.md')[2].replace('<h1>The cookbook</h1>', '<h2>How recipes are kept</h2>')

    def manuals_page(self):
        body = '<h1>Manuals</h1><p>Begin with nsd(7).</p>'
        for section, title in SECTIONS:
            rows = ''
            for m, f in sorted(self.manuals.items()):
                if m.endswith('.' + section):
                    what = re.search(r'^\.Nd (.*)', (TOP / f).read_text(), re.M)[1]
                    rows += f'<tr><td><a href="man/{m}">{m[:-2]}({section})</a></td><td>{html.escape(what)}</td></tr>'
            body += f'<h2>{title}</h2><table>{rows}</table>'
        return 'man', 'Manuals', body

    def folder_page(self, source):
        names = sorted(n for n in os.listdir(TOP / source) if not n.startswith(('.', '__')))
        return source, source, f'<h1>{source}</h1><ul>' + ''.join(f'<li><a href="{path.basename(source)}/{n}">{n}</a></li>' for n in names) + '</ul>'

    def make(self):
        self.out.mkdir(parents=True)
        jobs = [(self.text_page, f) for f in self.page if f.endswith('.md') and f != 'cookbook/README.md' and not f.startswith('docs/manual/')]
        jobs += [(self.manual_page, m) for m in self.manuals] + [(self.recipe_page, r) for r in self.recipes]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for page in pool.map(lambda job: job[0](job[1]), jobs):
                self.write(*page)
        self.write(*self.cookbook_page())
        self.write(*self.manuals_page())
        while self.folders:
            self.write(*self.folder_page(self.folders.pop()))
        for f in ('style.css', 'search.js'):
            shutil.copyfile(HERE / f, self.out / f)
        (self.out / 'search-index.js').write_text('var searchIndex = ' + json.dumps(self.index, ensure_ascii=False, separators=(',', ':')) + ';\n')


def main():
    for tool, package in TOOLS.items():
        if not shutil.which(tool):
            print(f'site.py: {tool}: no such program; it is in the Debian package {package}: apt-get install {package}', file=sys.stderr)
            return 69
    out = Path(sys.argv[1]).absolute()
    if out.exists() and not (out / 'search-index.js').exists():
        print(f'site.py: {out}: exists, and is not a site', file=sys.stderr)
        return 64
    new = out.with_name(out.name + '.new')
    shutil.rmtree(new, ignore_errors=True)
    site = Site(new, sys.argv[2:])
    try:
        site.make()
    except subprocess.CalledProcessError as e:
        print(f'site.py: {" ".join(e.cmd)}: {e.stderr.strip()}', file=sys.stderr)
        return 70
    for line in site.dead:
        print(f'site.py: {line}: no such file', file=sys.stderr)
    if site.dead:
        return 65
    shutil.rmtree(out, ignore_errors=True)
    new.rename(out)
    return 0


if __name__ == '__main__':
    sys.exit(main())
