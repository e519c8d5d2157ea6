#!/usr/bin/python3
"""Plays a page of nsd-web in headless Chromium: web.py PAGE SHOT.png; a line of JSON says what was seen."""
import json
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

options = Options()
for word in ['--headless=new', '--no-sandbox', '--disable-dev-shm-usage', '--use-gl=angle',
             '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--window-size=1100,800']:
    options.add_argument(word)
options.set_capability('goog:loggingPrefs', {'browser': 'ALL', 'performance': 'ALL'})
browser = webdriver.Chrome(options=options, service=Service('/usr/bin/chromedriver'))
browser.set_script_timeout(120)


def run(script):
    """What the body of an async function returns in the page"""
    return browser.execute_async_script(
        'const done = arguments[0]; (async () => {' + script + '})().then(x => done(x ?? null), e => done("error: " + e))')


def pixels():
    """A hash of the canvas"""
    return run('nsd.draw(); const u = document.getElementById("view").toDataURL(); let h = 0;'
               'for (let i = 0; i < u.length; i++) h = (31 * h + u.charCodeAt(i)) | 0; return h')


try:
    browser.get('file://' + sys.argv[1])
    start = time.time()
    while not browser.execute_script('return !!window.nsd') and time.time() - start < 60:
        time.sleep(0.1)
    seen = {'trouble': browser.execute_script('return document.getElementById("trouble").textContent')}
    seen['frames'] = run('return nsd.meta.frames.length')
    first = pixels()
    run('await nsd.go(nsd.meta.frames.length - 1)')
    seen['changes'] = pixels() != first
    seen['back'] = run('await nsd.go(0)') or pixels() == first
    # played by its button, it goes on by itself; and round, so one look could find the first frame again
    browser.find_element(By.ID, 'play').click()
    start, frames = time.time(), set()
    while len(frames) < min(3, seen['frames']) and time.time() - start < 60:
        frames.add(run('return nsd.frame.k'))
    seen['plays'] = len(frames) == 3
    browser.find_element(By.ID, 'play').click()
    run('await nsd.go(nsd.meta.frames.length - 1)')
    # a click where the nearest grain of the middle is seen reads that grain
    box = browser.find_element(By.ID, 'view').rect
    x, y = box['x'] + box['width'] / 2, box['y'] + box['height'] / 2
    seen['row'] = run('let best = -1, d = 1e9; for (let i = 0; i < nsd.frame.n; i++) { const [x, y] = nsd.seen(i);'
                      f'const e = Math.hypot(x - {x}, y - {y}); const p = nsd.pick(x, y);'
                      'if (p === i && e < d) d = e, best = i; } return best')
    at = run(f'return nsd.seen({seen["row"]})')
    action = ActionChains(browser)
    action.w3c_actions.pointer_action.move_to_location(round(at[0]), round(at[1]))
    action.w3c_actions.pointer_action.click()
    action.perform()
    seen['id'] = run('return nsd.frame.id[%d]' % seen['row'])
    seen['chosen'] = run('return nsd.chosen')
    seen['text'] = browser.find_element(By.ID, 'picked').text
    seen['position'] = run('const f = nsd.frame, i = %d; return [0, 1, 2].map(j => f.m.lo[j] + f.m.step[j] * f.x[4 * i + j])' % seen['row'])
    seen['images'] = run('return Array.from(nsd.frame.shown.row).sort()')
    # of two grains of one shape in the plane: how much of the ball around the first a click finds, and is coloured
    seen['part'] = run('''const f = nsd.frame; if (!f.shape || f.n !== 2) return null;
        const [a, b] = [nsd.seen(0), nsd.seen(1)], view = document.getElementById("view"), box = view.getBoundingClientRect();
        const x = i => [0, 1].map(j => f.m.lo[j] + f.m.step[j] * f.x[4 * i + j]);
        const r = f.radius[0] * Math.hypot(b[0] - a[0], b[1] - a[1]) / Math.hypot(x(1)[0] - x(0)[0], x(1)[1] - x(0)[1]);
        const copy = document.createElement("canvas"); copy.width = view.width, copy.height = view.height;
        nsd.draw(); const c = copy.getContext("2d"); c.drawImage(view, 0, 0);
        let all = 0, found = 0, coloured = 0;
        for (let i = -30; i <= 30; i++) for (let j = -30; j <= 30; j++) {
            if (i * i + j * j > 900) continue;
            const at = [a[0] + r * i / 30, a[1] + r * j / 30]; all++;
            found += nsd.pick(at[0], at[1]) === 0;
            const p = c.getImageData((at[0] - box.left) * view.width / box.width, (at[1] - box.top) * view.height / box.height, 1, 1).data;
            coloured += p[0] + p[1] + p[2] < 740;
        }
        return [found / all, coloured / all]''')
    seen['curves'] = run('return Object.keys(nsd.meta.curves)')
    before = pixels()
    network = browser.find_element(By.ID, 'network')
    seen['solved'] = network.is_displayed()
    if seen['solved']:
        network.click()
        seen['network'] = pixels() != before
    browser.save_screenshot(sys.argv[2])
    seen['console'] = [line['message'] for line in browser.get_log('browser') if line['level'] == 'SEVERE']
    seen['requests'] = [m['params']['request']['url'][:60] for m in
                        (json.loads(line['message'])['message'] for line in browser.get_log('performance'))
                        if m['method'] == 'Network.requestWillBeSent'
                        and not m['params']['request']['url'].startswith(('file:', 'blob:', 'data:'))]
finally:
    browser.quit()
print(json.dumps(seen))
