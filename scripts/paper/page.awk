# page.awk: the page from page.md: a line "@..." becomes a table, "@quick TEXT" TEXT in quick runs only.
#   @table N DIM SETTINGS    rows of tables/tableN.tsv      @claims, @closed DT    of those tables
# awk -f page.awk -v tables=DIR -v quick=1 page.md

function number(x)
{
    if (x == "" || x + 0 == x && x == int(x) && x < 1e7) return x
    return sprintf("%.3g", x)
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

function percent(x) { return x == "" ? "" : sprintf("%+.0f %%", 100 * x) }

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
        head("method;contacts;sweeps, last step;paper;eps_glob;paper;penetration;paper;of the motion;steps missed;CPU s;paper;to SBP;paper")
    getline line < file
    columns(line)
    while ((getline line < file) > 0) {
        fields(line)
        if (v["dim"] != dim || v["settings"] != settings) continue
        n = 0
        if (which == 4) c[++n] = v["alpha"]
        c[++n] = toupper(v["method"])
        if (which != 4) c[++n] = v["contacts"]
        c[++n] = v["sweeps"]
        c[++n] = v["sweeps_paper"]
        if (which != 4) {
            c[++n] = number(v["eps_glob"])
            c[++n] = number(v["eps_glob_paper"])
        }
        c[++n] = number(v["penetration"])
        c[++n] = number(v["penetration_paper"])
        c[++n] = number(v["penetration_true"])
        c[++n] = (v["state"] ~ /^diverged|^blew/ ? "**" v["state"] "**, " : "") v["missed"] " of " v["steps"]
        if (which == 4) {
            c[++n] = v["total_sweeps"]
            c[++n] = v["gave_up"]
        }
        c[++n] = number(v["seconds"])
        c[++n] = number(v["seconds_paper"])
        if (which != 4) {
            c[++n] = percent(v["to_sbp"])
            c[++n] = percent(v["to_sbp_paper"])
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

$1 == "@table" { table($2, $3, $4); next }
$1 == "@claims" { claims(); next }
$1 == "@closed" { closed($2); next }
$1 == "@quick" { if (quick) print substr($0, 8); next }
{ print }
