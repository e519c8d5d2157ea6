// The search: sections that have all words, those with the words in their heading first. The index is a script, which a page
// from a file may load, unlike JSON; it is loaded when the search is used.
(function () {
    'use strict';
    var form = document.getElementById('search'), input = form.querySelector('input'), list = form.querySelector('ul');
    var root = form.dataset.root, loading = false, most = 15;

    function load() {
        if (loading) return;
        loading = true;
        var script = document.createElement('script');
        script.src = root + '/search-index.js';
        script.onload = show;
        document.head.appendChild(script);
    }

    // What each word counts: the begin of a heading 8, a part of it 4, the title of the page 2, the text 1; twice in manuals,
    // half in pages about the project itself
    function score(row, words) {
        var title = row[1].toLowerCase(), heading = row[2].toLowerCase(), text = row[3].toLowerCase(), sum = 0;
        for (var i = 0; i < words.length; i++) {
            var at = heading.replace(/^-+/, '').indexOf(words[i].replace(/^-+/, ''));
            var s = (at === 0 ? 8 : at > 0 ? 4 : 0) + (title.includes(words[i]) ? 2 : 0) + (text.includes(words[i]) ? 1 : 0);
            if (!s) return 0;
            sum += s;
        }
        return sum * (/^man\//.test(row[0]) ? 2 : /^(CHANGELOG|CONTRIBUTING|tests|lib|bench)/.test(row[0]) ? 0.5 : 1);
    }

    function item(row, words) {
        var li = document.createElement('li'), a = document.createElement('a'), b = document.createElement('b'), p = document.createElement('span');
        var at = Math.max(0, row[3].toLowerCase().indexOf(words[0]) - 40);
        a.href = root + '/' + row[0];
        b.textContent = row[1] + (row[2] && row[2] !== row[1] ? ': ' + row[2] : '');
        p.textContent = (at ? '... ' : '') + row[3].slice(at, at + 140);
        a.append(b, p);
        li.append(a);
        return li;
    }

    function show() {
        var words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
        list.replaceChildren();
        list.hidden = !words.length;
        if (list.hidden || !window.searchIndex) return;
        var found = window.searchIndex.map(function (row) { return [score(row, words), row]; })
            .filter(function (f) { return f[0]; }).sort(function (a, b) { return b[0] - a[0]; });
        found.slice(0, most).forEach(function (f) { list.append(item(f[1], words)); });
        if (!found.length) list.textContent = 'No section has all of these words.';
    }

    input.addEventListener('focus', load);
    input.addEventListener('input', function () { load(); show(); });
    form.addEventListener('submit', function (e) {
        e.preventDefault();
        var a = list.querySelector('a');
        if (a) location.href = a.href;
    });
    document.addEventListener('click', function (e) { if (!form.contains(e.target)) list.hidden = true; });
    // on a narrow screen the contents are folded
    var contents = document.querySelector('.contents');
    if (contents && matchMedia('(max-width: 60em)').matches) contents.open = false;
})();
