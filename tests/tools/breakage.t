#!/usr/bin/env bash
# Grains that break: criteria by closed forms, Weibull's distribution, what is kept when a grain becomes fragments, threads,
# resuming, streams, the bound of a step, and what is refused.
# shellcheck source=tests/support/tap.sh disable=SC2016 # jq programs
. tests/support/tap.sh

have_h5py || { echo "1..0 # SKIP no h5py"; exit 0; }
step() { nsd-step "$@" 2>/dev/null; }
holds() { jq -e "$@" >/dev/null; }
# same A B: two documents, but for the commands in their history
same() {
    local group
    for group in particles nsd/breakage nsd/shape nsd/flow contacts; do
        cmp <(dump "$1" "/$group") <(dump "$2" "/$group") || return 1
    done
}

# scene BREAKS BODIES [MORE]: grains of 2600 kg/m^3 that do not meet, or as MORE has it
scene() {
    local still=', "gravity": [0, 0, 0]'
    [[ ${3-} != *gravity* ]] || still=
    echo '{ "dt": 1e-4'"$still"', "density": 2600, "seed": 5, "materials": { "g": { "breaks": '"$1"' } },
            "bodies": '"$2${3+, $3} }"
}
damage() { nsd-info --last -p "$1" | jq -c 'select(.damage != null).damage'; }

# ---- what a break costs ----

# small STRENGTH: small steps of 11 steps of 1 ms, 21 layers of balls, of which one has this strength
small() {
    jq -n "{ dt: 1e-3, density: 2600, seed: 5, mu: 0.4,
        materials: { other: {}, weak: { breaks: { by: \"force\", strength: $1, smallest: 1.5e-3 } } },
        walls: [{ box: { x: [0, 44e-3], y: [0, 44e-3], z: [0, null] } }],
        bodies: [range(10164) as \$i | { radius: 1e-3, material: (if \$i == 2000 then \"weak\" else \"other\" end),
            x: [(\$i % 22 * 2 + 1) * 1e-3, ((\$i / 22 | floor) % 22 * 2 + 1) * 1e-3, ((\$i / 484 | floor) * 2 + 1) * 1e-3] }] }" |
        nsd-gen - | nsd-step -n 11 --every 11 2>&1 >"$tmp/small-$1.h5" | sed -n 's/.* were made in \([0-9]*\) small ones/\1/p'
}
whole=$(small 1e12)
broken=$(small 1)
ok "a grain of 10 164 that breaks into pieces adds less than a fifth to the small steps: $whole, $broken" test $((5 * broken)) -lt $((6 * whole))
ok "and it has broken" holds -n "$(nsd-info --last "$tmp/small-1.h5" | jq -s '[.[] | select(.step != null)][0].bodies') > 10164"

# ---- loads, by closed forms ----

floor='"walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1] }]'
ball='[{ "x": [0, 0, 1e-3], "radius": 1e-3, "material": "g" }]'
near() { holds -n "if ($2) == 0 then ($1) == 0 else ($1) / ($2) - 1 | fabs < ${3-1e-9} end"; }
mass=$(jq -n '2600 * 4 / 3 * 3.14159265358979312 * 1e-9')

# load NAME BREAKS WANTED MORE: the damage of a ball after one step
load() {
    scene "$2" "${5-$ball}" "$4" | nsd-gen - | step --small-steps 0 -n 1 >"$tmp/load.h5"
    ok "$1" near "$(damage "$tmp/load.h5" | head -n 1)" "$3" 1e-6
}
load "a ball at rest has the load m g / d^2 over its strength" '{ "by": "force", "strength": 1e3, "smallest": 1e-3 }' \
    "$mass * 9.81 / 4e-6 / 1e3" "$floor, \"gravity\": [0, 0, -9.81]"
load "a ball that falls at v has that of v^2 / 2" '{ "by": "energy", "strength": 10, "smallest": 1e-3 }' \
    '9 / 2 / 10' "$floor" '[{ "x": [0, 0, 1e-3], "v": [0, 0, -3], "radius": 1e-3, "material": "g" }]'
load "with restitution, too, and less what does no damage" \
    '{ "by": "energy", "strength": 10, "least": 1, "smallest": 1e-3 }' '(9 / 2 - 1) / 10' "$floor, \"e_n\": 0.5" \
    '[{ "x": [0, 0, 1e-3], "v": [0, 0, -3], "radius": 1e-3, "material": "g" }]'
load "each of two equal balls that meet at 2 v has that of v^2 / 2" '{ "by": "energy", "strength": 10, "smallest": 1e-3 }' \
    '9 / 2 / 10' '"walls": []' '[{ "x": [0, 0, 1e-3], "v": [0, 0, -3], "radius": 1e-3, "material": "g" },
                  { "x": [0, 0, -1e-3], "v": [0, 0, 3], "radius": 1e-3, "material": "g" }]'
load "a ball at rest under a heavy lid has none" '{ "by": "energy", "strength": 1e-9, "smallest": 1e-3 }' 0 \
    "\"walls\": [{ \"point\": [0, 0, 0], \"normal\": [0, 0, 1] }, { \"point\": [0, 0, 2e-3], \"normal\": [0, 0, -1],
        \"load\": { \"along\": [0, 0, -1], \"force\": 500, \"mass\": 1e-6 } }]"
# between two plates of which one is pressed by F, the stress is F 2 R / V along z
plates="\"walls\": [{ \"point\": [0, 0, 0], \"normal\": [0, 0, 1] }, { \"point\": [0, 0, 2e-3], \"normal\": [0, 0, -1],
        \"load\": { \"along\": [0, 0, -1], \"force\": 0.5, \"mass\": 1e-6 } }]"
stress='0.5 * 2e-3 / (4 / 3 * 3.14159265358979312 * 1e-9)'
load "the mean stress of a ball between plates is F 2 R / 3 V" '{ "by": "stress", "strength": 1e6, "smallest": 1e-3 }' \
    "$stress / 3 / 1e6" "$plates"
load "its octahedral shear stress is sqrt(2) of that" '{ "by": "shear", "strength": 1e6, "smallest": 1e-3 }' \
    "$stress * (2 | sqrt) / 3 / 1e6" "$plates"
load "strength goes with size to the power of -3/m" \
    '{ "by": "force", "strength": 1e3, "size": 4e-3, "exponent": 1.5, "smallest": 1e-3 }' \
    "$mass * 9.81 / 4e-6 / 1e3 / pow(2; 1.5)" "$floor, \"gravity\": [0, 0, -9.81]"

# impacts that add up: a ball that is thrown again and again; [Tavares 2009] by his equation, solved by bisection, and by
# what it follows from: Hertz's law with a stiffness that falls as 1 - D, D = (x / x_c)^gamma of the approach x
hits='[{ "x": [0, 0, 1e-3], "v": [0, 0, -3], "radius": 1e-3, "material": "g" }]'
for law in linear tavares; do
    scene '{ "by": "energy", "strength": 10, "smallest": 1e-3, "damage": "'$law'" }' "$hits" "$floor" | nsd-gen - >"$tmp/hit.h5"
    for _ in 1 2; do
        step --small-steps 0 -n 1 "$tmp/hit.h5" >"$tmp/again.h5"
        py - "$tmp/again.h5" "$tmp/hit.h5" <<'END'
import sys, h5py, shutil
shutil.copy(sys.argv[1], sys.argv[2])
with h5py.File(sys.argv[2], 'r+') as f:
    f['/particles/all/velocity/value'][:] = [0, 0, -3]
    if 'memory' in f['/nsd']: del f['/nsd/memory']
END
        foreign "$tmp/hit.h5" "$tmp/bare.h5"
        mv "$tmp/bare.h5" "$tmp/hit.h5"
    done
    damage "$tmp/again.h5"
done >"$tmp/damages"
ok "two impacts of 0.45 add up to 0.9" near "$(head -n 1 "$tmp/damages")" 0.9
cat >"$tmp/tavares.py" <<'END'
import sys
import numpy as np
def D(e, g=5.0):
    lo, hi = 0.0, 1.0
    for _ in range(200):
        m = (lo + hi) / 2
        lo, hi = (m, hi) if (2*g*e / (2*g - 5*m + 5)) ** (2*g/5) > m else (lo, m)
    return lo
def hertz(e, g=5.0):
    x = np.linspace(0, 1, 200001)
    force = (1 - x ** g) * x ** 1.5
    work = np.concatenate([[0], np.cumsum(force[1:] + force[:-1])])
    return np.interp(e * work[-1], work, x) ** g
for law, most in (D, 1e-9), (hertz, 1e-6):
    d = law(0.45)
    d += (1 - d) * law(0.45 / (1 - d))
    if not abs(float(sys.argv[1]) / d - 1) < most: sys.exit(f"{law.__name__}: {d}")
END
ok "by Tavares to what his equation gives, and what it follows from" py "$tmp/tavares.py" "$(tail -n 1 "$tmp/damages")"

# ---- strengths of 1000 grains are the Weibull distribution put in: Kolmogorov and Smirnov, 1 % ----

scene '{ "by": "force", "strength": 1e3, "modulus": 3, "size": 2e-3, "smallest": 1e-3 }' \
    '[{ "count": 1000, "radius": 1e-3, "material": "g", "jitter": 0, "box": { "x": [0, 0.1], "y": [0, 0.1], "z": [0, 2.2e-3] } }]' \
    '"walls": [{ "point": [0, 0, 5e-5], "normal": [0, 0, 1] }], "gravity": [0, 0, -9.81]' | nsd-gen - >"$tmp/grains.h5"
step -n 3 "$tmp/grains.h5" --every 3 >"$tmp/loaded.h5"
cat >"$tmp/weibull.py" <<'END'
import sys, h5py, numpy as np
with h5py.File(sys.argv[1], 'r') as f:
    n = len(f['/particles/all/id/value'][-1][f['/particles/all/id/value'][-1] >= 0])
    load = f['/particles/all/damage/value'][-1][:n]
S = np.sort(load[load > 0].max() and float(sys.argv[2]) / 4e-6 / load)
F = 1 - np.exp(-(S / 1e3) ** 3)
D = max(np.max(np.arange(1, n + 1) / n - F), np.max(F - np.arange(n) / n))
print(n, D)
sys.exit(not (n == 1000 and D < 1.63 / np.sqrt(n)))
END
ok "the strengths of 1000 grains are Weibull's, by Kolmogorov and Smirnov" \
    py "$tmp/weibull.py" "$tmp/loaded.h5" "$(jq -n "$mass * 9.81")"

# ---- what is kept when a grain becomes fragments ----

solids='"shapes": { "brick": { "box": [3e-3, 2e-3, 1e-3] } }'
two='[{ "x": [0.01, 0.02, 0.03], "v": [1, 2, 3], "w": [40, -50, 60], "material": "g", "radius": 1e-3 },
      { "x": [0.03, -0.02, 0.01], "v": [-1, 2, -3], "w": [-30, 40, 70], "material": "g", "shape": "brick" }]'
flat='[{ "x": [0.01, 0.02], "v": [1, 2], "w": 40, "material": "g", "radius": 1e-3 }]'
cat >"$tmp/due.py" <<'END'
import sys, h5py
with h5py.File(sys.argv[1], 'r+') as f:
    f['/particles/all/damage/value'][:] = 1
END
# due DOCUMENT: its grains are due
due() { foreign "$1" "$tmp/due.h5" && py "$tmp/due.py" "$tmp/due.h5"; }
cat >"$tmp/energies.py" <<'END'
import sys, h5py, numpy as np
# mass, momentum, angular momentum about the origin, kinetic energy, of the last frame
def read(path):
    with h5py.File(path, 'r') as f:
        a = f['/particles/all']
        ids = a['id/value'][-1] if 'id/value' in f['/particles/all'] else None
        row = np.flatnonzero(ids >= 0)
        x, v, w, q = (a[k + '/value'][-1][row] for k in ('position', 'velocity', 'angular_velocity', 'orientation'))
        m, inertia, shape = a['mass'][()][row], a['inertia'][()][row], a['shape'][()][row]
        moment = np.vstack([[0.4] * 3 if f['/nsd'].attrs['dim'] == 3 else [0.5] * 3, f['/nsd/shape/moment'][()]])[shape]
        b = f['/nsd/breakage']
        dust = [b[k + '/value'][-1].sum(0) for k in ('dust_mass', 'dust_momentum', 'dust_kinetic')]
    P, T, L = m @ v, 0, np.cross(x, m[:, None] * v).sum(0)
    for k in range(len(m)):
        s, p = q[k][0], q[k][1:]
        c = np.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
        R = np.eye(3) + 2 * s * c + 2 * c @ c
        I = R @ np.diag(moment[k] / moment[k].mean() * inertia[k]) @ R.T
        L = L + I @ w[k]
        T += m[k] * v[k] @ v[k] / 2 + w[k] @ I @ w[k] / 2
    return m.sum(), P, L, T, dust
M, P, L, T, _ = read(sys.argv[1])
m, p, l, t, dust = read(sys.argv[2])
off = [abs(m + dust[0] - M) / M, np.linalg.norm(p + dust[1] - P) / np.linalg.norm(P), abs(t + dust[2] - T) / T]
if dust[0] == 0: off.append(np.linalg.norm(l - L) / np.linalg.norm(L))
print(off, dust[0] / M, len(sys.argv))
sys.exit(not max(off) < 1e-12)
END
# kept NAME BREAKS BODIES MORE: of grains that fly, which are due and break in a step of 1e-12 s
kept() {
    scene "$2" "$3" "$4" | nsd-gen - >"$tmp/whole.h5"
    due "$tmp/whole.h5"
    step --small-steps 0 --dt 1e-12 -n 0 "$tmp/due.h5" >"$tmp/start.h5"
    step --small-steps 0 --dt 1e-12 -n 1 "$tmp/due.h5" >"$tmp/broken.h5"
    ok "$1: mass, momentum and energy are kept, with the dust" py "$tmp/energies.py" "$tmp/start.h5" "$tmp/broken.h5"
    nsd-detect "$tmp/broken.h5" | nsd-info --contacts >"$tmp/gaps"
    ok "$1: the energy that nsd-stat has of breaking is what bodies have lost" holds -s '
        (.[0].energy | .kinetic + .rotation) as $was | .[1].energy | (.kinetic + .rotation + .breaking) / $was - 1 | fabs < 1e-12' \
        < <(for k in start broken; do nsd-stat -m energy "$tmp/$k.h5"; done)
    ok "$1: fragments that touch overlap by no more than rounding" \
        holds -s 'map(select(.gap != null).gap) | length > 5 and min > -1e-12' "$tmp/gaps"
}
kept "a brick in pieces, and angular momentum" '{ "by": "force", "strength": 1e3, "smallest": 1e-4, "pieces": 20 }' \
    "$(jq -c '.[1:]' <<<"$two")" "$solids"
kept "a ball and a brick in pieces" '{ "by": "force", "strength": 1e3, "smallest": 1e-4, "pieces": 9, "dust": 5e-4 }' "$two" "$solids"
kept "a ball in balls" '{ "by": "force", "strength": 1e3, "smallest": 1e-4, "into": "balls" }' "$(jq -c '.[:1]' <<<"$two")" \
    '"shapes": { "brick": { "box": [3e-3, 2e-3, 1e-3] } }'
ok "it becomes 13, of which each is of generation 1, with its parent and the time" \
    holds -s '[.[] | select(.parent == 0 and .generation == 1 and .born == 0)] | length == 13' < <(nsd-info --last -p "$tmp/broken.h5")
kept "a disc in pieces" '{ "by": "force", "strength": 1e3, "smallest": 1e-4 }' "$flat" '"dim": 2, "gravity": [0, 0]'


# ---- the balance of a run ----

hail='"walls": [{ "box": { "x": [0, 12e-3], "y": [0, 12e-3], "z": [0, null] } }], "gravity": [0, 0, -9.81], "mu": 0.4'
scene '{ "by": "energy", "strength": 0.3, "smallest": 2e-3, "pieces": 4 }' '[{ "count": 12, "radius": 2e-3, "material": "g", "v": [0, 0, -1],
    "box": { "x": [0, 12e-3], "y": [0, 12e-3], "z": [0, 0.05] } }]' "$hail" | nsd-gen - | step -n 60 --every 1 >"$tmp/hail.h5"
nsd-info "$tmp/hail.h5" | jq -c 'select(.step != null).balance | select(. != null)' >"$tmp/hail"
ok "from step to step the energy changes by what the balance has, with that of breaking" holds -s '
    . as $b | [range(1; length) | $b[. - 1] as $was | $b[.] | select(.small_steps > 0)
        | (.kinetic + .potential - $was.kinetic - $was.potential - (.drives + .loads - .dissipation - .breaking)) / ($was.kinetic + $was.potential)
        | fabs] | length > 30 and max < 1e-13' "$tmp/hail"
ok "which is the energy of the dust" holds -s '(map(.breaking) | add) as $sum | $sum > 1e-7' "$tmp/hail"

# ---- threads, resuming, streams: grains of two kinds that fall into a box and break, again and again ----

cat >"$tmp/rain.json" <<'END'
{ "dt": 2e-4, "gravity": [0, 0, -9.81], "density": 2600, "seed": 3, "mu": 0.4,
  "materials": { "grain": { "breaks": { "by": "force", "strength": 4e2, "size": 4e-3, "modulus": 3, "smallest": 2.6e-3, "pieces": 4 } },
             "soft": { "breaks": { "by": "energy", "strength": 0.05, "smallest": 2.6e-3, "into": "balls", "damage": "linear" } } },
  "bodies": [{ "count": 8, "radius": { "uniform": [1.5e-3, 2e-3] }, "material": "grain", "v": [0, 0, -1],
               "box": { "x": [0, 0.02], "y": [0, 0.02], "z": [0, 0.02] } }],
  "pour": [{ "rate": 300, "opening": { "box": { "x": [0.005, 0.015], "y": [0.005, 0.015], "z": [0.03, 0.04] } },
             "radius": 2e-3, "v": [0, 0, -1], "material": "soft", "count": 10 }],
  "walls": [{ "box": { "x": [0, 0.02], "y": [0, 0.02], "z": [0, null] } }] }
END
nsd-gen "$tmp/rain.json" >"$tmp/rain.h5"
run() { nsd-step --small-steps 0 --every 20 --contacts "$@"; }
run -n 160 -o "$tmp/out.h5" "$tmp/rain.h5" 2>"$tmp/said"
like "what has broken is said at the end" "$(cat "$tmp/said")" 'grains have broken into [0-9]+ fragments and [0-9.e-]+ kg of dust, which had [0-9.e-]+ J'
ok "grains of both kinds have broken, some twice" \
    holds -s '[.[] | select(.generation > 0)] | map(.material) | unique == ["grain", "soft"]' < <(nsd-info --last -p "$tmp/out.h5")
total=$(nsd-info -p "$tmp/rain.h5" | jq -s 'map(.mass // 0) | add')
ok "mass is that of the start, of pours and of dust" py - "$tmp/out.h5" "$total" <<'END'
import sys, h5py, numpy as np
with h5py.File(sys.argv[1], 'r') as f:
    row = np.flatnonzero(f['/particles/all/id/value'][-1] >= 0)
    now = f['/particles/all/mass'][()][row].sum() + f['/nsd/breakage/dust_mass/value'][-1].sum()
    was = float(sys.argv[2]) + f['/nsd/flow/poured_mass/value'][-1].sum()
sys.exit(not abs(now / was - 1) < 1e-13)
END
run -j 3 -n 160 -o "$tmp/j3.h5" "$tmp/rain.h5" 2>/dev/null
ok "3 threads give the bytes of one" same "$tmp/j3.h5" "$tmp/out.h5"
for k in 60 100; do
    run -n $k -o "$tmp/half.h5" "$tmp/rain.h5" 2>/dev/null
    run -n $((160 - k)) -i "$tmp/half.h5" 2>/dev/null
    ok "a run that resumes after step $k gives the same document" same "$tmp/half.h5" "$tmp/out.h5"
    step --small-steps 0 --every 20 -n $((160 - k)) <(nsd-cat -s 0:$k "$tmp/out.h5") >"$tmp/rest.h5"
    ok "so does one from that frame of the whole trajectory" \
        cmp <(nsd-info --last -p "$tmp/rest.h5") <(nsd-info --last -p "$tmp/out.h5")
done
run -n 160 "$tmp/rain.h5" 2>/dev/null | nsd-cat >"$tmp/stream.h5"
ok "a stream packed is the trajectory" same "$tmp/stream.h5" "$tmp/out.h5"
ok "nsd-stat, nsd-view and nsd-export read each frame" \
    eval 'nsd-stat "$tmp/out.h5" >/dev/null && nsd-view -o "$tmp/view" "$tmp/out.h5" && nsd-export --to xyz -o "$tmp/x" "$tmp/out.h5"'
# balls that fall on a floor at 1 m/s, by energy
scene '{ "by": "energy", "strength": 0.1, "smallest": 2.6e-3, "into": "balls" }' \
    '[{ "count": 8, "radius": 2e-3, "material": "g", "v": [0, 0, -1], "box": { "x": [0, 0.02], "y": [0, 0.02], "z": [0, 0.02] } }]' \
    "$floor" | nsd-gen - >"$tmp/soft.h5"
for j in 1 3; do step -j $j -n 30 "$tmp/rain.h5" --every 30 >"$tmp/small$j.h5"; done
ok "with small steps, too, 3 threads give the bytes of one" same_particles "$tmp/small3.h5" "$tmp/small1.h5"
for every in 1 40; do step -n 40 --every $every "$tmp/soft.h5" | nsd-info --last -p | jq -c 'select(.mass != null)' >"$tmp/every$every"; done
ok "with small steps grains break" holds -s 'any(.generation > 0)' "$tmp/every40"
ok "whether or not each step is kept" cmp "$tmp/every1" "$tmp/every40"

# ---- instruments ----

py - >"$tmp/fractal.txt" <<'END'
for i in range(1, 2001): # N grains are larger than d: d^-2.5
    r = 1e-3 * i ** -0.4
    print(repr(3e-3 * (i % 50)), repr(3e-3 * (i // 50)), 1e-2, repr(r))
END
echo '{ "dt": 1e-4, "gravity": [0, 0, -9.81], "density": 2600, "bodies": [{ "file": "fractal.txt" }],
        "walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1] }] }' >"$tmp/fractal.json"
nsd-gen "$tmp/fractal.json" >"$tmp/fractal.h5"
nsd-stat -m breakage,grading "$tmp/fractal.h5" >"$tmp/fits"
ok "2000 grains of sizes i^-0.4 have the fractal dimension 2.5" \
    holds '.breakage.dimension - 2.5 | fabs < 0.05' "$tmp/fits"
cat >"$tmp/fits.py" <<'END'
import sys, json, numpy as np
b = json.load(open(sys.argv[1]))
d = 2e-3 * np.arange(2000, 0, -1.0) ** -0.4
e = d[0] * (d[-1] / d[0]) ** (np.arange(51) / 50)
P = np.array([(d[d < x * (1 - 1e-12)] ** 3).sum() for x in e]) / (d ** 3).sum()
k = (P >= 0.01) & (P <= 0.9)
a, c = np.polyfit(np.log(e[k]), np.log(P[k]), 1)
k = (P >= 0.01) & (P <= 0.99)
n, f = np.polyfit(np.log(e[k]), np.log(-np.log(1 - P[k])), 1)
want = dict(ggs_exponent=a, ggs_size=np.exp(-c / a), rr_exponent=n, rr_size=np.exp(-f / n),
            d50=d[np.searchsorted(np.cumsum(d ** 3), 0.5 * (d ** 3).sum())])
off = [abs(b['breakage'][q] / want[q] - 1) for q in want]
print(off, max(abs(np.array(b['grading']['passing']) - P)))
sys.exit(not (max(off) < 1e-9 and max(abs(np.array(b['grading']['passing']) - P)) < 1e-12))
END
ok "the fits of Gates, Gaudin, Schuhmann and of Rosin, Rammler are those of numpy" py "$tmp/fits.py" "$tmp/fits"
nsd-stat -m breakage "$tmp/out.h5" | tail -n 1 >"$tmp/stat"
ok "the fractions that have broken are those of the document" holds --slurpfile b "$tmp/stat" -s '
    [.[] | select(.mass != null)] as $g | ([$g[] | select(.generation > 0).mass] | add) as $m |
    $b[0].breakage | (.fragments - ($m + .dust) / (([$g[].mass] | add) + .dust) | fabs < 1e-12) and .generation >= 1' \
    < <(nsd-info --last -p "$tmp/out.h5")
ok "nsd-view draws generations and damage" \
    eval 'nsd-view -c generation -o "$tmp/g.png" "$tmp/out.h5" && nsd-view -c damage -o "$tmp/d.png" "$tmp/out.h5"'
nsd-export --to csv -o "$tmp/x.csv" "$tmp/out.h5"
like "exports have the family and the damage" "$(head -n 3 "$tmp"/x*.csv | tr '\n' ' ')" 'parent.*generation.*born.*damage'

# ---- the bound of a step ----

scene '{ "by": "force", "strength": 1e3, "smallest": 1e-3, "into": "balls", "dust": 1 }' \
    '[{ "count": 1100, "radius": 1e-3, "material": "g", "box": { "x": [0, 0.03], "y": [0, 0.03], "z": [0, null] } }]' | nsd-gen - >"$tmp/all.h5"
due "$tmp/all.h5"
nsd-step -n 1 "$tmp/due.h5" 2>"$tmp/said" >"$tmp/some.h5"
like "1100 grains are due: 1000 break in a step, which is said" "$(cat "$tmp/said")" '100 grains that are due to break wait: 1000 break in a step'
is "the others are there" "$(nsd-info --last "$tmp/some.h5" | jq 'select(.step != null).bodies')" 100
is "and break in the next" "$(step -n 1 "$tmp/some.h5" | nsd-info | jq 'select(.step != null).bodies')" 0

# ---- together with other things ----

weak='{ "by": "force", "strength": 20, "smallest": 1.5e-3, "into": "balls" }'
tower='[{ "x": [0, 0, 1e-3], "radius": 1e-3, "material": "g", "fixed": true }, { "x": [0, 0, 3e-3], "radius": 1e-3, "material": "g" },
    { "x": [0, 0, 5e-3], "radius": 1e-3, "material": "g" }]'
ground='"walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1], "material": "g" }], "gravity": [0, 0, -9.81]'
for small in 0 0.01; do
    scene "$weak" "$tower" "$ground" | nsd-gen - | step --small-steps $small -n 20 >"$tmp/tower.h5"
    is "a held ball and a wall of a material that breaks stay, R = $small" \
        "$(nsd-info --last -p "$tmp/tower.h5" | jq -s -c '[.[] | select(.id != null)] | [length > 3, (.[] | select(.id == 0) | .generation)]')" '[true,0]'
    scene "$weak" "${tower/\"fixed\": true/\"v\": [0, 0, 0]}" "$ground, "'"pairs": [{ "pair": ["g", "g"], "adhesion": { "c_n": 2e9, "c_t": 1e9, "w": 0.2, "eta": 1e-4 } }]' |
        nsd-gen - | step --small-steps $small -n 20 >"$tmp/glued.h5"
    is "bonded grains break, R = $small" "$(nsd-info --last "$tmp/glued.h5" | jq 'select(.step != null).bodies')" 39
    scene '{ "by": "force", "strength": 100, "smallest": 1.5e-3 }' \
        '[{ "count": 20, "radius": 1e-3, "material": "g", "box": { "x": [0, 0.01], "y": [0, 0.01], "z": [0, 0.01] } }]' \
        '"cell": { "lengths": [0.01, 0.01, 0.01], "stress": { "pressure": 1000, "mass": 1e-3 } }' | nsd-gen - >"$tmp/cell.h5"
    step --small-steps $small -n 60 "$tmp/cell.h5" >"$tmp/pressed.h5"
    ok "in a cell under a pressure grains break, and mass is that of the start, R = $small" holds -n \
        "$(nsd-stat -m breakage "$tmp/pressed.h5" | tail -n 1 | jq .breakage) as \$b | \$b.broken > 0.2 and
        (($(nsd-info --last -p "$tmp/pressed.h5" | jq -s 'map(.mass // 0) | add') + \$b.dust) / $(nsd-info -p "$tmp/cell.h5" | jq -s 'map(.mass // 0) | add') - 1 | fabs) < 1e-13"
done

# ---- what is refused ----

breaks() { # NAME PATTERN BREAKS [BODIES [MORE]]
    scene "$3" "${4-$ball}" "${5-$floor}" >"$tmp/bad.json"
    refuses 65 "$1 is refused" nsd-gen "$tmp/bad.json"
    like "with its place" "$(cat "$tmp/err")" "$2"
}
for strength in 0 -1 '"nan"' null; do
    breaks "a strength of $strength" 'bad.json:.*materials.g.breaks.strength' '{ "by": "force", "strength": '"$strength"', "smallest": 1e-3 }'
done
breaks "no strength" 'materials.g.breaks.strength: is missing' '{ "by": "force", "smallest": 1e-3 }'
breaks "no smallest size" 'materials.g.breaks.smallest: is missing' '{ "by": "force", "strength": 1 }'
breaks "no such criterion" 'materials.g.breaks.by' '{ "by": "will", "strength": 1, "smallest": 1e-3 }'
breaks "more fragments than there is room for" 'materials.g.breaks.smallest: .*more than 16777216 fragments' \
    '{ "by": "force", "strength": 1, "smallest": 1e-6 }'
for pieces in 1 65 2.5 -3; do
    breaks "$pieces pieces" 'materials.g.breaks.pieces' '{ "by": "force", "strength": 1, "smallest": 1e-3, "pieces": '$pieces' }'
done
breaks "a modulus of 0" 'materials.g.breaks.modulus' '{ "by": "force", "strength": 1, "smallest": 1e-3, "modulus": 0 }'
breaks "an exponent without a size" 'materials.g.breaks.size: is missing' '{ "by": "force", "strength": 1, "smallest": 1e-3, "exponent": 1 }'
breaks "damage by force" 'materials.g.breaks.damage: goes with "by": "energy"' \
    '{ "by": "force", "strength": 1, "smallest": 1e-3, "damage": "linear" }'
breaks "a rounded brick" 'materials.g.breaks: only balls and polyhedra without a round break, and body 0 has the shape "brick"' \
    '{ "by": "force", "strength": 1, "smallest": 1e-3 }' '[{ "x": [0, 0, 0.1], "material": "g", "shape": "brick" }]' \
    '"shapes": { "brick": { "box": [3e-3, 2e-3, 1e-3], "round": 1e-4 } }'
breaks "a clump" 'materials.g.breaks: only balls and polyhedra without a round break, and body 0 has the shape "pair"' \
    '{ "by": "force", "strength": 1, "smallest": 1e-3 }' '[{ "x": [0, 0, 0.1], "radius": 1e-3, "material": "g", "shape": "pair" }]' \
    '"shapes": { "pair": { "balls": [[-0.5, 0, 0, 0.5], [0.5, 0, 0, 0.5]] } }'
breaks "a brick into balls" 'materials.g.breaks: only balls break into balls' \
    '{ "by": "force", "strength": 1, "smallest": 1e-3, "into": "balls" }' '[{ "x": [0, 0, 0.1], "material": "g", "shape": "brick" }]' "$solids"

# documents that are meant to harm
foreign "$tmp/out.h5" "$tmp/whole.h5"
crafted() { # NAME PATTERN PYTHON
    cp "$tmp/whole.h5" "$tmp/bad.h5"
    py - "$tmp/bad.h5" "$3" <<'END'
import sys, h5py
with h5py.File(sys.argv[1], 'r+') as f: exec(sys.argv[2])
END
    refuses 65 "a document with $1 is refused" nsd-step -n 1 -o "$tmp/never.h5" "$tmp/bad.h5"
    like "with its place" "$(cat "$tmp/err")" "$2"
}
crafted "a strength that is no number" 'breakage of material 2: strength' "f['/nsd/breakage/strength'][2] = float('nan')"
crafted "another criterion" 'breakage of material grain: by is no criterion' "f['/nsd/breakage/by'][2] = 7"
crafted "a damage of 2" 'damage must lie in' "f['/particles/all/damage/value'][-1, :] = 2"
crafted "more shapes in a frame than there are" '/nsd/shape/count/value' "f['/nsd/shape/count/value'][-1] = 1000000"
crafted "a shape without a name" '/nsd/shape@names: fewer names' "f['/nsd/shape/fragment'][-1] = -5"
crafted "two shapes of one fragment" 'two shapes have one name' "f['/nsd/shape/fragment'][-1] = f['/nsd/shape/fragment'][-2]"
crafted "fewer than no grains that have broken" 'broken must' "f['/nsd/breakage/broken/value'][-1, 2] = -1"

done_testing
