# shellcheck shell=bash
# common.sh: what the benchmarks share. Sourced from bash -euo pipefail, in the project's root.

PATH=$(cd "${NSD_BUILD:-build}" && pwd):$PATH # the tools
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cpu=$(lscpu | awk -F': *' '/^Model name/ { print $2; exit }')
vectors=$(lscpu | grep -o -w -e avx512f -e avx2 | sort | tail -n 1 || true) # one name has many processors
vectors=${vectors%f}
# each machine's by themselves: "Intel(R) Xeon(R) Processor" is intel-xeon-processor-avx512
results=bench/results/$(sed 's/([A-Za-z]*)//g; s/[^A-Za-z0-9]\+/-/g; s/-$//' <<< "$cpu${vectors:+ $vectors}" | tr '[:upper:]' '[:lower:]')
export PATH work results

# The machine line of every result: what it ran on, and no date.
machine() {
    echo "$cpu${vectors:+, $vectors}, $(nproc) cores; $(${CC:-cc} --version | head -n 1)"
}

# median and spread of the numbers on standard input: "median<TAB>least<TAB>most"
median() {
    sort -g |
        awk '{ x[NR] = $1 }
             END { m = int((NR + 1) / 2)
                   print (NR % 2 ? x[m] : (x[m] + x[m + 1]) / 2) "\t" x[1] "\t" x[NR] }'
}

# The TSV on standard input (comments begin with #) as a Markdown table
markdown() {
    awk -F'\t' '/^#/ { next }
        { gsub(/[|]/, "\\|"); gsub(/\t/, " | "); print "| " $0 " |" }
        !n++ { gsub(/[^|]+/, " --- ", $0); print "|" $0 "|" }'
}
