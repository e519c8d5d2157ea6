#!/usr/bin/env bash
# The same bytes on machines that fuse multiplications and on those that do not: libm has other code
# for each, and other last bits.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

same() # command ...: of $tmp/in
{
    "$@" <"$tmp/in" >"$tmp/with" &&
        GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2 "$@" <"$tmp/in" >"$tmp/without" &&
        [ -s "$tmp/with" ] && cmp "$tmp/with" "$tmp/without"
}

cat >"$tmp/in" <<'EOF'
{ "dt": 1e-4, "bodies": [{ "count": 20000, "thermal": 0.1, "radius":
               { "lognormal": { "median": 4e-4, "sigma": 0.2, "min": 3e-4, "max": 6e-4 } } }],
  "walls": [{ "box": { "x": [-0.05, 0.05], "y": [-0.05, 0.05], "z": [0, null] } }] }
EOF
ok "gen: sizes and speeds of normal laws" same nsd-gen -

jq -n '{ dt: 1e-3, bodies: [range(8000) | { radius: 1e-3, x: [., 0, 0], w: [200, . / 4, -. / 7] }] }' |
    nsd-gen - >"$tmp/in"
ok "step: each ball spins at its own speed" same nsd-step -n 2
done_testing
