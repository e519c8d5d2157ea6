# paper.mk: every table and every figure of the paper, from runs of the tools (make paper).
#
# A run is SCENE_SETTINGS_METHOD, for instance example2-2d_paper_sal; SCENE is one of scenes/paper,
# SETTINGS one of
#   nsd       nsd's defaults
#   paper     the paper's own: alpha 0.6 (sbp, sal) or 1 (ebp, eal), the plain Newton, its error absolute
#   plain-A   table 4: alpha A, the plain Newton
#   line-A    the same with nsd's line search
#
#   runs/*.h5, *.log   the last two frames of a run; a line for each of its solves
#   runs.json          a line for each run: what the tables are made from
#   times.tsv          CPU seconds, apart: nothing else here differs from one machine to the next
#   tables/, figures/  what the page shows; README.md, index.html: the page
#
# What is there is not made again: to start afresh remove the folder.

QUICK ?=
OUT   ?= build/paper$(if $(QUICK),-quick)
P     := scripts/paper
export PATH := $(CURDIR)/build:$(PATH)
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.SECONDARY:

all: $(OUT)/index.html
	@echo "paper: $(OUT)/index.html, $(OUT)/README.md" >&2

# ---- what the paper has, and what is run ----

METHODS  := sbp sal ebp eal
SCENES   := example1 example2 example3
DIMS     := $(SCENES) $(SCENES:%=%-2d)
ALPHAS   := 5 2 1 0.5 0.2

# steps, and the error that ends a solve; by example, table 4's by its settings
n_example1 := 2000
n_example2 := 1000
n_example3 := $(if $(QUICK),600,1000)
n_alpha    := 500
cap        := $(if $(QUICK),500,5000)
run_example1 := -n $(n_example1) --eps 1e-10
run_example2 := -n $(n_example2) --eps 1e-12
run_example3 := -n $(n_example3) --eps 1e-12 --max-sweeps $(cap)
run_alpha    := -n $(n_alpha) --eps 1e-8 --max-sweeps $(cap)

TABLES := $(foreach s,$(DIMS),$(METHODS:%=$s_nsd_%) $s_nsd_exact $(METHODS:%=$s_paper_%))
TABLE4 := $(foreach s,example3 example3-2d,$(foreach a,$(ALPHAS),$(METHODS:%=$s_line-$a_%) \
          $s_plain-$a_ebp $s_plain-$a_eal))
RUNS   := $(TABLES) $(TABLE4)

# ---- one run ----

part      = $(word $1,$(subst _, ,$*))
scene     = $(call part,1)
settings  = $(call part,2)
method    = $(call part,3)
example   = $(firstword $(subst -, ,$(scene)))
alpha     = $(word 2,$(subst -, ,$(settings)))
projected = $(filter sbp sal,$(method))

literal        := --newton plain --newton-abs 1e-5
options_nsd    :=
options_paper   = $(if $(projected),--alpha 0.6,--alpha 1 $(literal))
options_line    = --alpha $(alpha)
options_plain   = --alpha $(alpha) $(literal)
options         = $(options_$(firstword $(subst -, ,$(settings)))) $(if $(alpha),$(run_alpha),$(run_$(example)))
steps           = $(if $(alpha),$(n_alpha),$(n_$(example)))
solve_options   = $(filter-out -n $(steps),$(options))

# The last two frames: the last solve can be made again. Exit status 1: a solve diverged, the run ends.
$(OUT)/runs/%.h5 $(OUT)/runs/%.log: | $(OUT)/runs
	@rm -f $(@D)/$*.*
	@nsd-gen scenes/paper/$(scene).json | nsd-step -m $(method) $(options) --every $$(($(steps) - 1)) \
	    --log $(@D)/$*.part -o $(@D)/$*.h5 2> $(@D)/$*.err || [ $$? = 1 ]
	@mv $(@D)/$*.part $(@D)/$*.log
	@echo "paper: $$(find $(@D) -name '*.log' | wc -l) of $(words $(RUNS)): $*: $$(tail -n 1 $(@D)/$*.err)" >&2

$(OUT)/runs/%.json: $(OUT)/runs/%.h5 $(OUT)/runs/%.log $P/summary.jq
	@jq -s -c -f $P/summary.jq --arg run $* --argjson steps $(steps) $(@D)/$*.log \
	    --argjson frame "$$(nsd-info --last $(@D)/$*.h5 | tail -n 1)" > $@

$(OUT)/runs.json: $(RUNS:%=$(OUT)/runs/%.json)
	@cat $^ > $@

# ---- CPU seconds: of each run; again, several times and the methods in turn, what is quickly made ----

# Examples 1 and 2 whole, of example 3 500 sweeps of its last step: SCENE_SETTINGS_METHOD_ROUND.
ROUNDS := $(if $(QUICK),1,9)
TIMES  := $(foreach r,$(shell seq $(ROUNDS)),$(TABLES:%=%_$r)) $(RUNS:%=%_run)

whole  = nsd-gen scenes/paper/$(scene).json | nsd-step -m $(method) $(options) --every $(steps)
sweeps = nsd-cat --last $(OUT)/runs/$(scene)_nsd_exact.h5 | nsd-detect | \
         nsd-solve -m $(method) $(options_$(settings)) --max-sweeps 500 --eps 0

$(OUT)/times/%.json: $(OUT)/runs.json | $(OUT)/times
	@$(if $(filter example3,$(example)),$(sweeps),$(whole)) --log $@.part > /dev/null 2>&1 || [ $$? = 1 ]
	@jq -s -c '{ run: "$*", seconds: (map(.seconds) | add) }' $@.part > $@
	@rm $@.part

$(OUT)/times/%_run.json: $(OUT)/runs/%.log | $(OUT)/times
	@jq -s -c '{ run: "$*_run", seconds: (map(.seconds) | add) }' $< > $@

$(OUT)/times.tsv: $(TIMES:%=$(OUT)/times/%.json) $P/times.jq
	@cat $(TIMES:%=$(OUT)/times/%.json) | jq -r -s -f $P/times.jq > $@

# ---- tables ----

N := 1 2 3 4

$(OUT)/tables/table%.tsv: $(OUT)/runs.json $(OUT)/times.tsv $P/tables.jq $P/paper.json | $(OUT)/tables
	@jq -r -s -f $P/tables.jq --arg table $* --rawfile times $(OUT)/times.tsv \
	    --slurpfile paper $P/paper.json $(OUT)/runs.json > $@

# Example 1 against its closed solution, SCENE_METHOD_DT: x and v every ms of 0.2 s; of exact also
# the first contacts that stick.
DTS    := 1e-3 5e-4 2e-4 1e-4 $(if $(QUICK),,5e-5 2e-5 1e-5)
CLOSED := $(foreach s,example1 example1-2d,$(foreach m,$(METHODS) exact,$(DTS:%=$s_$m_%)))
throw   = jq -f $P/closed-scene.jq --argjson dt $(call part,3) scenes/paper/$(scene).json | nsd-gen - | \
          nsd-step -m $(call part,2) --eps 1e-14 -n $$(jq -n '$1 / $(call part,3) | round')

$(OUT)/closed/%.tsv: $P/closed-scene.jq $P/closed.jq | $(OUT)/closed
	@{ $(call throw,0.2) --every $$(jq -n '0.001 / $(call part,3) | round') | nsd-info --particles; \
	   $(if $(filter exact,$(call part,2)),$(call throw,0.08) --contacts | nsd-info --contacts | grep '"stick"';) } 2> /dev/null | \
	    jq -n -r -f $P/closed.jq --arg scene $(scene) --arg method $(call part,2) --argjson dt $(call part,3) > $@

$(OUT)/tables/closed.tsv: $(CLOSED:%=$(OUT)/closed/%.tsv) | $(OUT)/tables
	@printf 'dim\tmethod\tdt\terror_x\terror_v\tlate\n' > $@
	@cat $^ >> $@

$(OUT)/tables/claims.tsv: $(OUT)/runs.json $(OUT)/times.tsv $(OUT)/tables/closed.tsv $P/claims.jq
	@jq -r -s -f $P/claims.jq --rawfile times $(OUT)/times.tsv --rawfile closed $(OUT)/tables/closed.tsv \
	    $(OUT)/runs.json > $@

# ---- figures ----

SVG  := signorini coulomb coulombcone strobe closed $(foreach m,$(METHODS) exact,$(foreach s,$(SCENES),conv-$s-$m))
PNG  := $(foreach s,$(DIMS),$s-start $s-end)

# The law: one-contact problems that nsd-solve solved, on the graphs.
$(OUT)/data/%.tsv: $P/laws.jq | $(OUT)/data
	@jq -n -f $P/laws.jq --arg law $* | nsd-gen - | nsd-detect --gap 1e-4 | nsd-solve -m exact 2> /dev/null | nsd-info --contacts | \
	    jq -r '[.u[], .r[]] | @tsv' > $@

$(OUT)/figures/signorini.svg $(OUT)/figures/coulomb.svg $(OUT)/figures/coulombcone.svg: \
    $(OUT)/figures/%.svg: $(OUT)/data/%.tsv $P/laws.gp | $(OUT)/figures
	@gnuplot -e "law='$*'; data='$<'; out='$@'" $P/laws.gp

# The four terms and their sum, sweep by sweep, of the step that the paper shows.
shown_example1 := 5

$(OUT)/history/%.tsv: $(OUT)/runs/%.h5 $P/history.jq | $(OUT)/history
	@$(if $(shown_$(example)), \
	    nsd-gen scenes/paper/$(scene).json | nsd-step -m $(method) $(options_$(settings)) --eps 1e-10 \
	        -n $$(($(shown_$(example)) - 1)) 2> /dev/null | nsd-cat --last, \
	    nsd-cat --steps $$(($(steps) - 1)):$$(($(steps) - 1)) $<) | \
	    nsd-detect | nsd-solve -m $(method) $(solve_options) --history 2> /dev/null | \
	    nsd-info --history | jq -r -s -f $P/history.jq > $@

# Balls with nsd's settings, discs with the paper's: where they converge.
define convergence
$(OUT)/figures/conv-$1-$2.svg: $(OUT)/history/$1_nsd_$2.tsv \
    $(OUT)/history/$1-2d_$(if $(filter exact,$2),nsd,paper)_$2.tsv $P/convergence.gp | $(OUT)/figures
	@gnuplot -e "method='$2'; balls='$$(word 1,$$^)'; discs='$$(word 2,$$^)'; out='$$@'" $P/convergence.gp
endef
$(foreach s,$(SCENES),$(foreach m,$(METHODS) exact,$(eval $(call convergence,$s,$m))))

$(OUT)/figures/closed.svg: $(OUT)/tables/closed.tsv $P/closed.gp | $(OUT)/figures
	@gnuplot -e "data='$<'; out='$@'" $P/closed.gp

# The ball of example 1 every 20 ms: where it is and how far it has turned.
$(OUT)/data/strobe.tsv: | $(OUT)/data
	@{ nsd-gen scenes/paper/example1.json; \
	   nsd-gen scenes/paper/example1.json | nsd-step -m exact -n 1200 --every 200 2> /dev/null; } | nsd-info --particles | \
	    jq -r '[.x[0], .x[2], .radius, 2 * atan2(.q[2]; .q[0])] | @tsv' > $@

$(OUT)/figures/strobe.svg: $(OUT)/data/strobe.tsv $P/strobe.gp | $(OUT)/figures
	@gnuplot -e "data='$<'; out='$@'" $P/strobe.gp

view = nsd-view --size $(if $(findstring -2d,$*),640x400,400x520) 2> /dev/null

$(OUT)/figures/%-start.png: scenes/paper/%.json | $(OUT)/figures
	@nsd-gen $< | $(view) > $@

$(OUT)/figures/%-end.png: $(OUT)/runs/%_nsd_exact.h5 | $(OUT)/figures
	@$(view) $< > $@

# ---- the page ----

PARTS := $(N:%=table%) claims closed

$(OUT)/README.md: $P/page.md $P/page.awk $(PARTS:%=$(OUT)/tables/%.tsv) \
    $(SVG:%=$(OUT)/figures/%.svg) $(PNG:%=$(OUT)/figures/%.png)
	@awk -f $P/page.awk -v tables=$(OUT)/tables -v quick='$(QUICK)' $< > $@

$(OUT)/index.html: $(OUT)/README.md $P/page.css
	@pandoc --self-contained --standalone --from gfm --css $P/page.css \
	    --metadata title="nsd: the paper, every table and figure" --resource-path $(OUT) -o $@ $<

$(OUT)/runs $(OUT)/times $(OUT)/tables $(OUT)/closed $(OUT)/data $(OUT)/history $(OUT)/figures:
	@mkdir -p $@

# What a reader sees who runs nothing.
all-keep: all
	mkdir -p docs/paper
	rm -rf docs/paper/tables docs/paper/figures
	cp -r $(OUT)/README.md $(OUT)/index.html $(OUT)/runs.json $(OUT)/tables $(OUT)/figures docs/paper/

.PHONY: all all-keep
