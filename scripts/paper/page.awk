# page.awk: the page from page.md: a line "@..." becomes a table, "@quick TEXT" TEXT in quick runs only.
#   @table N DIM SETTINGS    rows of tables/tableN.tsv      @tsv NAME KEY|- TITLES  a table as it is,
#                                                            of the rows with this first column; ~ is a space
#   @summary, @claims, @closed DT, @seeds, @motion          of those tables
# awk -f page.awk -v tables=DIR -v quick=1 page.md

function number(x)
{
    if (x == "" || x + 0 == x && x == int(x) && x < 1e7) return x
    return sprintf(x >= 100 && x < 1e7 ? "%.0f" : "%.3g", x)
}

# A median with its lowest and highest, where there are several
function spread(name,    low, high)
{
    low = v[name "_low"]
    high = v[name "_high"]
    if (low == high) return number(v[name])
    return number(v[name]) " (" number(low) " to " number(high) ")"
}

function row(n, c,    i, line)
{
    line = "|"
    for (i = 1; i <= n; i++) line = line " " c[i] " |"
    print line
}

function head(titles,    c, n, i)
{
    n = split(titles, c, ";")
    row(n, c)
    for (i = 1; i <= n; i++) c[i] = i == 1 ? ":--" : "--:"
    row(n, c)
}

function times(x) { return x == "" ? "" : sprintf(x < 10 ? "%.2g" : "%.0f", x) }

# A time over SBP's, of which two digits are all that repeat
function times_spread(name,    low, high)
{
    low = times(v[name "_low"])
    high = times(v[name "_high"])
    return times(v[name]) (low == high ? "" : " (" low " to " high ")")
}

# The header of a TSV names its columns
function columns(line,    f, n, i)
{
    n = split(line, f, "\t")
    for (i = 1; i <= n; i++) name[i] = f[i]
}

function fields(line,    f, n, i)
{
    split("", v)
    n = split(line, f, "\t")
    for (i = 1; i <= n; i++) v[name[i]] = f[i]
}

function table(which, dim, settings,    file, line, c, n)
{
    file = tables "/table" which ".tsv"
    if (which == 4)
        head("alpha;method;sweeps, last step;paper;penetration;paper;of the motion;steps missed;sweeps, all steps;local solves given up;CPU s;paper")
    else
        head("method;contacts;sweeps, last step;paper;eps_glob;paper;penetration;paper;of the motion;steps missed;CPU s;paper;over SBP;paper")
    getline line < file
    columns(line)
    while ((getline line < file) > 0) {
        fields(line)
        if (v["dim"] != dim || v["settings"] != settings) continue
        n = 0
        if (which == 4) c[++n] = v["alpha"]
        c[++n] = toupper(v["method"])
        if (which != 4) c[++n] = spread("contacts")
        c[++n] = spread("sweeps")
        c[++n] = v["sweeps_paper"]
        if (which != 4) {
            c[++n] = spread("eps_glob")
            c[++n] = number(v["eps_glob_paper"])
        }
        c[++n] = spread("penetration")
        c[++n] = number(v["penetration_paper"])
        c[++n] = spread("penetration_true")
        c[++n] = (v["state"] ~ /^diverged|^blew/ ? "**" v["state"] "**, " : "") spread("missed") " of " v["steps"]
        if (which == 4) {
            c[++n] = v["total_sweeps"]
            c[++n] = v["gave_up"]
        }
        c[++n] = spread("seconds")
        c[++n] = number(v["seconds_paper"])
        if (which != 4) {
            c[++n] = times_spread("over_sbp")
            c[++n] = times(v["over_sbp_paper"])
        }
        row(n, c)
    }
    close(file)
}

function claims(    file, line, c)
{
    file = tables "/claims.tsv"
    print "| the paper's claim | what we find | verdict |\n|:--|:--|:--|"
    getline line < file
    columns(line)
    while ((getline line < file) > 0) {
        fields(line)
        c[1] = v["claim"]
        c[2] = v["found"]
        c[3] = "**" v["verdict"] "**" (v["timed"] == "" ? "" : " (a matter of time, on one machine)")
        row(3, c)
    }
    close(file)
}

# The claims by verdict, each by its name
function summary(    file, line, k, of, list, word)
{
    file = tables "/claims.tsv"
    getline line < file
    columns(line)
    while ((getline line < file) > 0) {
        fields(line)
        of[v["verdict"]]++
        list[v["verdict"]] = list[v["verdict"]] (list[v["verdict"]] == "" ? "" : "; ") v["name"] (v["timed"] == "" ? "" : "\\*")
    }
    close(file)
    split("holds;holds in part;does not hold", word, ";")
    for (k = 1; k <= 3; k++)
        if (of[word[k]]) print "- **" toupper(substr(word[k], 1, 1)) substr(word[k], 2) "** (" of[word[k]] "): " list[word[k]] "."
}

# A table whose cells are as they should be shown
function plain_table(which, key, titles,    file, line, f, c, n, i)
{
    file = tables "/" which ".tsv"
    gsub(/~/, " ", titles)
    head(titles)
    getline line < file
    while ((getline line < file) > 0) {
        n = split(line, f, "\t")
        if (key != "-" && f[1] != key) continue
        for (i = key == "-" ? 1 : 2; i <= n; i++) c[i - (key != "-")] = f[i] ~ /^(sbp|sal|ebp|eal|exact)$/ ? toupper(f[i]) : f[i]
        row(n - (key != "-"), c)
    }
    close(file)
}

# Steps missed of example 2, a line for each method, a column for each seed
function seeds(    file, line, c, n, key, last)
{
    file = tables "/seeds.tsv"
    head("balls or discs, settings, method;seed 1;2;3;4;5;6;7;8;9;10")
    getline line < file
    columns(line)
    while ((getline line < file) > 0) {
        fields(line)
        key = (v["dim"] == 3 ? "balls" : "discs") ", " (v["settings"] == "nsd" ? "nsd\047s" : "the paper\047s") ", " toupper(v["method"])
        if (key != last) {
            if (n) row(n, c)
            n = 0
            c[++n] = last = key
        }
        c[++n] = v["missed"]
    }
    row(n, c)
    close(file)
}

function motion(    file, line, c)
{
    file = tables "/motion.tsv"
    head("picture;step;time, s;fastest body, m/s;median, m/s")
    getline line < file
    columns(line)
    while ((getline line < file) > 0) {
        fields(line)
        c[1] = (v["scene"] ~ /2d/ ? "discs" : "balls") ", " (v["picture"] == "end" ? "as the paper stops" : "at rest")
        c[2] = v["step"]
        c[3] = number(v["time"])
        c[4] = sprintf("%.2g", v["fastest"])
        c[5] = sprintf("%.1g", v["median"])
        row(5, c)
    }
    close(file)
}

function closed(dt,    file, line, c)
{
    file = tables "/closed.tsv"
    head("method;balls: error of x, m;of v, m/s;discs: error of x, m;of v, m/s")
    getline line < file
    columns(line)
    while ((getline line < file) > 0) {
        fields(line)
        if (v["dt"] + 0 == dt + 0) {
            x[v["method"], v["dim"]] = number(v["error_x"])
            u[v["method"], v["dim"]] = number(v["error_v"])
        }
    }
    close(file)
    split("sbp sal ebp eal exact", m, " ")
    for (k = 1; k <= 5; k++) {
        c[1] = toupper(m[k])
        c[2] = x[m[k], 3]
        c[3] = u[m[k], 3]
        c[4] = x[m[k], 2]
        c[5] = u[m[k], 2]
        row(5, c)
    }
}

$1 == "@summary" { summary(); next }
$1 == "@tsv" { plain_table($2, $3, $4); next }
$1 == "@seeds" { seeds(); next }
$1 == "@motion" { motion(); next }
$1 == "@table" { table($2, $3, $4); next }
$1 == "@claims" { claims(); next }
$1 == "@closed" { closed($2); next }
$1 == "@quick" { if (quick) print substr($0, 8); next }
{ print }
