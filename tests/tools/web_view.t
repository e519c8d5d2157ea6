#!/usr/bin/env bash
# nsd-web's page in a browser: it begins with grains in view, its address has time and view, curves have units.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

cp cookbook/web-page/scene.json "$tmp"
jq '.pour[].from = 0.02 | .pour[0].count = 20 | .pour[1].count = 0' "$tmp/scene.json" | nsd-gen - |
    nsd-step --contacts --until 0.1 --every 0.01s -o "$tmp/pour.h5" 2>/dev/null
nsd-stat -m energy,temperature,stress "$tmp/pour.h5" >"$tmp/stat.jsonl" 2>/dev/null
nsd-web --stat "$tmp/stat.jsonl" -o "$tmp/page.html" "$tmp/pour.h5" 2>/dev/null
meta() { sed -n 's/.*id="meta">\(.*\)<\/script>/\1/p' "$tmp/page.html" | jq -r "$1"; }
is "curves of nsd-stat have units, and vectors a curve a component" \
    "$(meta '[.curves["energy.kinetic"].unit, .curves["temperature.velocity.z"].unit, .curves["stress.p"].unit // "", .curves["temperature.bodies"].unit] | tojson')" '["J","m/s","Pa",""]'
nsd-gen -d 2 20 | nsd-step -n 20 --every 10 --contacts -o "$tmp/flat.h5" 2>/dev/null
nsd-stat -m stress "$tmp/flat.h5" >"$tmp/flat.jsonl" 2>/dev/null
nsd-web --stat "$tmp/flat.jsonl" "$tmp/flat.h5" 2>/dev/null | sed -n 's/.*id="meta">\(.*\)<\/script>/\1/p' >"$tmp/flat.json"
is "in the plane a stress is in N/m" "$(jq -r '.curves["stress.p"].unit // empty' "$tmp/flat.json")" 'N/m'
if ! command -v chromium >/dev/null || ! /usr/bin/python3 -c 'import selenium' 2>/dev/null; then
    skip "in a browser" "no chromium, or no selenium"
    done_testing
    exit
fi
cat >"$tmp/look.py" <<'END'
import json, sys, time
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
options = Options()
for word in ['--headless=new', '--no-sandbox', '--disable-dev-shm-usage', '--use-gl=angle', '--use-angle=swiftshader',
             '--enable-unsafe-swiftshader', '--window-size=1000,700']:
    options.add_argument(word)
options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
browser = webdriver.Chrome(options=options, service=Service('/usr/bin/chromedriver'))
def open_page(address):
    browser.get('about:blank')
    browser.get(address)
    start = time.time()
    while not browser.execute_script('return !!window.nsd') and time.time() - start < 60: time.sleep(0.1)
try:
    page, seen = 'file://' + sys.argv[1], {}
    open_page(page)
    seen['first'] = browser.execute_script('return [nsd.frame.k, nsd.frame.n, nsd.meta.frames[0].n, nsd.fitted]')
    # all corners of what there is are in the picture, and reach far into it
    seen['reach'] = browser.execute_script('''const box = document.getElementById("view").getBoundingClientRect();
        const at = Array.from({ length: nsd.frame.n }, (_, i) => nsd.seen(i));
        return at.every(([x, y]) => x > box.left && x < box.right && y > box.top && y < box.bottom)''')
    seen['away'] = browser.execute_script('return nsd.eye.away')
    time.sleep(0.6)
    seen['hash'] = browser.execute_script('return location.hash')
    open_page(page + '#t=0.08&az=77&el=10&away=2.5&x=0.01&y=0.02&z=0.03&colour=material')
    seen['asked'] = browser.execute_script('return [nsd.frame.m.t, nsd.eye.azimuth, nsd.eye.elevation, nsd.eye.away, document.getElementById("colour").value, nsd.fitted]')
    time.sleep(0.6)
    seen['again'] = browser.execute_script('return location.hash')
    open_page(page + '#t=nonsense&az=1e999&away=-3&colour=%3Cb%3E')
    seen['nonsense'] = browser.execute_script('return [nsd.frame.k, nsd.eye.azimuth, nsd.fitted]')
    browser.save_screenshot(sys.argv[2])
    seen['console'] = [m['message'] for m in browser.get_log('browser') if m['level'] == 'SEVERE']
    print(json.dumps(seen))
finally:
    browser.quit()
END
look() { timeout 200 /usr/bin/python3 "$tmp/look.py" "$tmp/page.html" "$tmp/shot.png" >"$tmp/seen" 2>"$tmp/why" || { tail -3 "$tmp/why"; return 1; }; }
ok "a browser shows it" look
seen() { jq -c "$1" "$tmp/seen"; }
is "the first frames are empty, and it begins with one that is not" "$(seen '[.first[0] > 0, .first[1] > 0, .first[2], .first[3]]')" '[true,true,0,true]'
is "all grains are in view" "$(seen .reach)" true
is "the address has the time, and no view where it is the fitted one" "$(seen '[(.hash | test("^#t=0.0")), (.hash | test("az="))]')" '[true,false]'
is "an address with time and view is heeded" "$(seen '[(.asked[0] - 0.08 | fabs) < 1e-6, .asked[1:]]')" '[true,[77,10,2.5,"material",false]]'
is "and is the page's own then" "$(seen '.again | test("t=0.08.*az=77&el=10&away=2.5")')" true
is "one that makes no sense is not" "$(seen '[.nonsense[0] > 0, .nonsense[1], .nonsense[2]]')" '[true,30,true]'
is "nothing is wrong on the console" "$(seen .console)" '[]'
done_testing
