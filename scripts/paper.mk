# paper.mk: every table and every figure of the paper, from runs of the tools (make paper).
#
# A run is SCENE_SETTINGS_METHOD, SCENE_SETTINGS_METHOD_SEED or SCENE_SETTINGS_METHOD_SEED_BOX, for instance
# example2-2d_paper_sal_3: SCENE is one of scenes/paper, SEED and BOX (its width, mm) replace the scene's own,
# SETTINGS is one of
#   nsd       nsd's step and Newton
#   paper     the paper's own: alpha 0.6 (sbp, sal) or 1 (ebp, eal), the plain Newton, its error absolute
#   plain-A   table 4: alpha A, the plain Newton
#   line-A    the same with nsd's line search
#   bond      nsd's, with bonds of BOND weights wherever grains touch
# Always the paper's protocol, whatever the tools' defaults: nsd-detect --overlap-rule keep; nsd-solve and nsd-step --protocol paper,
# which is Gauss-Seidel from 0, the paper's criterion, nothing done about overlap.
#
#   runs/*.h5, *.log   the last two frames of a run; a line for each of its solves
#   runs.json          a line for each run: what the tables are made from
#   same.json          the same contact problems given to every method
#   times.tsv          CPU seconds, apart: nothing else here differs from one machine to the next
#   tables/, figures/  what the page shows; README.md: the page
#
# What is there is not made again: to start afresh remove the folder.

QUICK ?=
OUT   ?= build/paper$(if $(QUICK),-quick)
P     := scripts/paper
# make takes a blank for the end of a name, the shell a quote for its own
$(if $(findstring ',$(OUT))$(word 2,$(OUT)),$(error paper.mk: OUT=$(OUT): the name of the folder has a blank or a quote))
export PATH := $(CURDIR)/build:$(PATH)
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.SECONDARY:

all: $(OUT)/README.md
	@echo "paper: $(OUT)/README.md" >&2

# ---- what the paper has, and what is run ----

METHODS  := sbp sal ebp eal
SCENES   := example1 example2 example3
DIMS     := $(SCENES) $(SCENES:%=%-2d)
ALPHAS   := 5 2 1 0.5 0.2

# How example 2 goes depends on where its four balls start and on the box, and the paper gives neither.
SEEDS := 1 2 3 4 5 6 7 8 9 10
BOXES := $(if $(QUICK),1.3 1.8,1.3 1.4 1.5 1.7 1.8)
# Piles of example 3 of which every method is given the last problem; 1 is the scene's own
PILES := $(if $(QUICK),1 2 3,1 2 3 4 5)

# steps, and the error that ends a solve; by example, table 4's by its settings
n_example1 := 2000
n_example2 := 1000
n_example3 := $(if $(QUICK),600,1000)
n_alpha    := 500
n_rest     := $(if $(QUICK),2000,6000)
cap        := $(if $(QUICK),500,5000)
limits_example1 := --protocol paper --tolerance 1e-10 --max-sweeps 5000
limits_example2 := --protocol paper --tolerance 1e-12 --max-sweeps $(cap)
limits_example3 := --protocol paper --tolerance 1e-12 --max-sweeps $(cap)
limits_alpha    := --protocol paper --tolerance 1e-8 --max-sweeps $(cap)

all_of  = $(METHODS:%=$1_nsd_%) $1_nsd_exact $(METHODS:%=$1_paper_%)
TABLES := $(foreach s,$(filter-out example2%,$(DIMS)),$(call all_of,$s))
TABLE2 := $(foreach k,$(SEEDS),$(foreach s,example2 example2-2d,$(patsubst %,%_$k,$(call all_of,$s))))
BOXED  := $(foreach b,$(BOXES),$(foreach k,$(SEEDS),$(patsubst %,example2_nsd_%_$k_$b,sbp ebp)))
PILED  := $(foreach s,example3 example3-2d,$(patsubst %,$s_nsd_exact_%,$(filter-out 1,$(PILES))))
TABLE4 := $(foreach s,example3 example3-2d,$(foreach a,$(ALPHAS),$(METHODS:%=$s_line-$a_%) \
          $s_plain-$a_ebp $s_plain-$a_eal))
RUNS   := $(TABLES) $(TABLE2) $(BOXED) $(PILED) $(TABLE4)

# The same with adhesion: balls, nsd's settings. A bond bears BOND weights of a ball: in example 3 close to half of the
# bonds are whole at the end, nearly all others are damaged.
BOND        := 30
BOND_SEEDS  := $(if $(QUICK),1 2 3,$(SEEDS))
BOND_ROUNDS := $(if $(QUICK),1,1 2 3 4 5)
BONDED      := $(foreach m,$(METHODS) exact,example1_bond_$m $(BOND_SEEDS:%=example2_bond_$m_%) example3_bond_$m)

# ---- one run ----

part      = $(word $1,$(subst _, ,$*))
scene     = $(call part,1)
settings  = $(call part,2)
method    = $(call part,3)
seed      = $(call part,4)
box       = $(call part,5)
example   = $(firstword $(subst -, ,$(scene)))
alpha     = $(word 2,$(subst -, ,$(settings)))
projected = $(filter sbp sal,$(method))

literal        := --newton plain --newton-abs 1e-5
options_nsd    :=
options_paper   = $(if $(projected),--alpha 0.6,--alpha 1 $(literal))
options_line    = --alpha $(alpha)
options_plain   = --alpha $(alpha) $(literal)
options         = $(options_$(firstword $(subst -, ,$(settings)))) $(if $(alpha),$(limits_alpha),$(limits_$(example)))
steps           = $(if $(alpha),$(n_alpha),$(n_$(example)))

# The scene with the run's seed and box, as a packing
bond    = $(if $(filter bond,$(settings)),| jq -f $P/bond.jq --argjson weights $(BOND))
packing = jq -f $P/scene.jq --arg seed '$(seed)' --arg box '$(box)' scenes/paper/$(scene).json $(bond) | nsd-gen -

# The last two frames: the last solve can be made again. Exit status 1: a solve diverged, the run ends.
$(OUT)/runs/%.h5 $(OUT)/runs/%.log: | $(OUT)/runs
	@rm -f $(@D)/$*.*
	@$(packing) | nsd-step -m $(method) -n $(steps) $(options) --every $$(($(steps) - 1)) \
	    --log $(@D)/$*.part -o $(@D)/$*.h5 2> $(@D)/$*.err || [ $$? = 1 ]
	@mv $(@D)/$*.part $(@D)/$*.log
	@echo "paper: $$(find $(@D) -name '*.log' | wc -l) of $(words $(RUNS) $(BONDED)): $*: $$(grep -m 1 ' sweeps, ' $(@D)/$*.err)" >&2

$(OUT)/runs/%.json: $(OUT)/runs/%.h5 $(OUT)/runs/%.log $P/summary.jq
	@jq -s -c -f $P/summary.jq --arg run $* --argjson steps $(steps) $(@D)/$*.log \
	    --argjson frame "$$(nsd-info --last $(@D)/$*.h5 | tail -n 1)" > $@

$(OUT)/runs.json: $(RUNS:%=$(OUT)/runs/%.json)
	@cat $^ > $@

# ---- one contact problem for every method ----

# Piles are chaotic: after 1000 steps each method has a pile of its own, and what it leaves there is no comparison.
# So all are given the last problem of exact's piles, SCENE_SETTINGS_METHOD_PILE; where the methods converge,
# with nsd's settings on balls, the paper's on discs.
fair = $(foreach k,$3,$(foreach m,$(METHODS) exact,$1_$(if $(filter exact,$m),nsd,$2)_$m_$k))
SAME := $(call fair,example2,nsd,$(SEEDS)) $(call fair,example2-2d,paper,$(SEEDS)) \
        $(call fair,example3,nsd,$(PILES)) $(call fair,example3-2d,paper,$(PILES))

last_problem_of = nsd-cat --frames $$(($2 - 1)):$$(($2 - 1)) $1 | nsd-detect
last_problem    = $(call last_problem_of,$1,$(steps))

$(OUT)/same/%.json: $(OUT)/runs.json | $(OUT)/same
	@$(call last_problem,$(OUT)/runs/$(scene)_nsd_exact$(if $(filter example3_1,$(example)_$(seed)),,_$(seed)).h5) | \
	    nsd-solve -m $(method) $(options) 2> /dev/null | nsd-info --last | \
	    jq -c '{ scene: "$(scene)", method: "$(method)", pile: $(seed) } + .' > $@

$(OUT)/same.json: $(SAME:%=$(OUT)/same/%.json)
	@cat $^ > $@

# ---- with adhesion ----

# A run's summary, how many of its last contacts have bonds that are whole, damaged and broken, and its CPU seconds
$(OUT)/adhesion/%.json: $(OUT)/runs/%.json | $(OUT)/adhesion
	@nsd-cat --last $(OUT)/runs/$*.h5 | nsd-detect | nsd-info --contacts | \
	    jq -s -c -f $P/bonds.jq --slurpfile run $< --slurpfile log $(OUT)/runs/$*.log > $@

$(OUT)/adhesion.json: $(BONDED:%=$(OUT)/adhesion/%.json)
	@cat $^ > $@

BOND_SAME := $(foreach m,$(METHODS) exact,$(BOND_SEEDS:%=example2_bond_$m_%) example3_bond_$m_1)

$(OUT)/adhesion-same/%.json: $(OUT)/adhesion.json | $(OUT)/adhesion-same
	@$(call last_problem,$(OUT)/runs/$(scene)_bond_exact$(if $(filter example2,$(example)),_$(seed)).h5) | \
	    nsd-solve -m $(method) $(options) 2> /dev/null | nsd-info --last | \
	    jq -c '{ scene: "$(scene)", method: "$(method)", pile: $(seed) } + .' > $@

$(OUT)/adhesion-same.json: $(BOND_SAME:%=$(OUT)/adhesion-same/%.json)
	@cat $^ > $@

# 500 sweeps of the last problem of example 3, the methods in turn, ROUND_METHOD
$(OUT)/adhesion-times/%.json: $(OUT)/adhesion.json | $(OUT)/adhesion-times
	@$(call last_problem_of,$(OUT)/runs/example3_bond_exact.h5,$(n_example3)) | \
	    nsd-solve -m $(call part,2) --protocol paper --max-sweeps 500 --tolerance 0 --log $@.part > /dev/null 2>&1
	@jq -s -c '{ method: "$(call part,2)", round: $(call part,1), seconds: (map(.seconds) | add) }' $@.part > $@
	@rm $@.part

$(OUT)/adhesion-times.json: $(foreach r,$(BOND_ROUNDS),$(foreach m,$(METHODS) exact,$(OUT)/adhesion-times/$r_$m.json))
	@cat $^ > $@

$(OUT)/tables/adhesion-%.tsv: $(OUT)/adhesion.json $(OUT)/adhesion-same.json $(OUT)/adhesion-times.json $P/adhesion.jq $P/stats.jq | $(OUT)/tables
	@jq -r -s -L $P -f $P/adhesion.jq --arg table $* --slurpfile same $(OUT)/adhesion-same.json \
	    --slurpfile times $(OUT)/adhesion-times.json $< > $@

# ---- CPU seconds ----

# As in the paper, of whole runs: the run itself is round 0; what the claims stand on is run again, the methods in
# turn, ROUND/RUN. Beside it stand 500 sweeps of one problem of example 3, sweeps-ROUND/RUN.
rounds_example1 := $(if $(QUICK),,1 2 3 4 5 6 7 8)
rounds_example2 := $(if $(QUICK),,1 2)
rounds_example3 := $(if $(QUICK),,1 2)
rounds_sweeps   := $(if $(QUICK),1,1 2 3 4 5 6 7 8 9)

CLAIMED := $(filter example1_% example1-2d_%,$(TABLES)) $(filter example2_nsd_% example2-2d_paper_%,$(TABLE2)) \
           $(filter example3_nsd_% example3-2d_paper_%,$(TABLES))
TIMES   := $(foreach e,1 2 3,$(foreach r,$(rounds_example$e),$(patsubst %,$r/%,$(filter example$e%,$(CLAIMED))))) \
           $(foreach r,$(rounds_sweeps),$(patsubst %,sweeps-$r/%,$(filter example3%,$(CLAIMED))))

seconds = jq -s -c '{ run: "$*", what: "$1", round: $2, seconds: (map(.seconds) | add) }'

define timed
$(OUT)/times/$1/%.json: $(OUT)/runs.json | $(OUT)/times/$1
	@$$(packing) | nsd-step -m $$(method) -n $$(steps) $$(options) --every $$(steps) --log $$@.part > /dev/null 2>&1 || [ $$$$? = 1 ]
	@$$(call seconds,whole,$1) $$@.part > $$@
	@rm $$@.part
endef
$(foreach r,$(rounds_example1),$(eval $(call timed,$r)))

define timed_sweeps
$(OUT)/times/sweeps-$1/%.json: $(OUT)/runs.json | $(OUT)/times/sweeps-$1
	@$$(call last_problem,$(OUT)/runs/$$(scene)_nsd_exact.h5) | \
	    nsd-solve -m $$(method) $$(options_$$(settings)) --protocol paper --max-sweeps 500 --tolerance 0 --log $$@.part > /dev/null 2>&1
	@$$(call seconds,sweeps,$1) $$@.part > $$@
	@rm $$@.part
endef
$(foreach r,$(rounds_sweeps),$(eval $(call timed_sweeps,$r)))

$(OUT)/times/0/%.json: $(OUT)/runs/%.log | $(OUT)/times/0
	@$(call seconds,whole,0) $< > $@

$(OUT)/times.tsv: $(RUNS:%=$(OUT)/times/0/%.json) $(TIMES:%=$(OUT)/times/%.json)
	@{ printf 'run\twhat\tround\tseconds\n'; cat $^ | jq -r '[.run, .what, .round, .seconds] | @tsv'; } > $@

# ---- tables ----

N := 1 2 3 4
ADHESION := adhesion-rows adhesion-same adhesion-claims

$(OUT)/tables/table%.tsv: $(OUT)/runs.json $(OUT)/times.tsv $P/tables.jq $P/paper.json $P/stats.jq | $(OUT)/tables
	@jq -r -s -L $P -f $P/tables.jq --arg table $* --rawfile times $(OUT)/times.tsv \
	    --slurpfile paper $P/paper.json $(OUT)/runs.json > $@

# Example 2 run by run, and by the width of its box; one problem for every method
$(OUT)/tables/seeds.tsv $(OUT)/tables/boxes.tsv: $(OUT)/tables/%.tsv: $(OUT)/runs.json $P/%.jq $P/stats.jq | $(OUT)/tables
	@jq -r -s -L $P -f $P/$*.jq $< > $@

$(OUT)/tables/same.tsv: $(OUT)/same.json $P/same.jq $P/stats.jq | $(OUT)/tables
	@jq -r -s -L $P -f $P/same.jq $< > $@

# Example 1 against its closed solution, SCENE_METHOD_DT: x and v every ms of 0.2 s; of exact also the first
# contacts that stick, sought from 0.06 s on: a ball rolls after 62 ms, a disc after 73.
DTS    := 1e-3 5e-4 2e-4 1e-4 $(if $(QUICK),,5e-5 2e-5 1e-5)
CLOSED := $(foreach s,example1 example1-2d,$(foreach m,$(METHODS) exact,$(DTS:%=$s_$m_%)))
go      = nsd-step -m $(call part,2) --protocol paper --tolerance 1e-14 --max-sweeps 5000 -n $$(jq -n '$1 / $(call part,3) | round')
throw   = jq -f $P/closed-scene.jq --argjson dt $(call part,3) scenes/paper/$(scene).json | nsd-gen - | $(call go,$1)

$(OUT)/closed/%.tsv: $P/closed-scene.jq $P/closed.jq | $(OUT)/closed
	@{ $(call throw,0.2) --every $$(jq -n '0.001 / $(call part,3) | round') | nsd-info -b; \
	   $(if $(filter exact,$(call part,2)), $(call throw,0.06) --every 1000000 | $(call go,0.02) --contacts | \
	       nsd-info --contacts | grep '"stick"';) } 2> /dev/null | \
	    jq -n -r -f $P/closed.jq --arg scene $(scene) --arg method $(call part,2) --argjson dt $(call part,3) > $@

$(OUT)/tables/closed.tsv: $(CLOSED:%=$(OUT)/closed/%.tsv) | $(OUT)/tables
	@printf 'dim\tmethod\tdt\terror_x\terror_v\tlate\n' > $@
	@cat $^ >> $@

$(OUT)/tables/claims.tsv: $(OUT)/runs.json $(OUT)/same.json $(OUT)/times.tsv $(OUT)/tables/closed.tsv $P/claims.jq $P/stats.jq
	@jq -r -s -L $P -f $P/claims.jq --rawfile times $(OUT)/times.tsv --rawfile closed $(OUT)/tables/closed.tsv \
	    --slurpfile same $(OUT)/same.json $(OUT)/runs.json > $@

# ---- figures ----

PILED_UP := example3 example3-2d
SVG  := signorini coulomb coulombcone strobe closed $(SCENES:%=conv-%)
PNG  := $(foreach s,$(DIMS),$s-start $s-end) $(PILED_UP:%=%-rest)

# The law: one-contact problems that nsd-solve solved, on the graphs.
$(OUT)/data/%.tsv: $P/laws.jq | $(OUT)/data
	@jq -n -f $P/laws.jq --arg law $* | nsd-gen - | nsd-detect --overlap-rule keep --gap 1e-4 | \
	    nsd-solve -m exact --protocol paper --tolerance 1e-10 --max-sweeps 5000 2> /dev/null | \
	    nsd-info --contacts | \
	    jq -r '[.u[], .r[]] | @tsv' > $@

$(OUT)/figures/signorini.svg $(OUT)/figures/coulomb.svg $(OUT)/figures/coulombcone.svg: \
    $(OUT)/figures/%.svg: $(OUT)/data/%.tsv $P/laws.gp | $(OUT)/figures
	@gnuplot -e "law='$*'; data='$<'; out='$@'" $P/laws.gp

# The four terms and their sum, sweep by sweep, of the step that the paper shows.
shown_example1 := 5

$(OUT)/history/%.tsv: $(OUT)/runs/%.h5 $P/history.jq | $(OUT)/history
	@$(if $(shown_$(example)), \
	    $(packing) | nsd-step -m $(method) $(options) \
	        -n $$(($(shown_$(example)) - 1)) 2> /dev/null | nsd-cat --last | nsd-detect, \
	    $(call last_problem,$<)) | \
	    nsd-solve -m $(method) $(options) --history 2> /dev/null | \
	    nsd-info --history | jq -r -s -f $P/history.jq > $@

# Balls with nsd's settings, discs with the paper's: where they converge. Of example 2 the scene's own seed.
shown_seed = $(if $(filter example2,$1),_9)
histories = $(foreach m,$(METHODS) exact,$(OUT)/history/$1_$(if $(filter exact,$m),nsd,$2)_$m$(call shown_seed,$(firstword $(subst -, ,$1))).tsv)
define convergence
$(OUT)/figures/conv-$1.svg: $(call histories,$1,nsd) $(call histories,$1-2d,paper) $P/convergence.gp | $(OUT)/figures
	@gnuplot -e "balls='$(call histories,$1,nsd)'; discs='$(call histories,$1-2d,paper)'; out='$$@'" $P/convergence.gp
endef
$(foreach s,$(SCENES),$(eval $(call convergence,$s)))

$(OUT)/figures/closed.svg: $(OUT)/tables/closed.tsv $P/closed.gp | $(OUT)/figures
	@gnuplot -e "data='$<'; out='$@'" $P/closed.gp

# The ball of example 1 every 20 ms: where it is and how far it has turned.
$(OUT)/data/strobe.tsv: | $(OUT)/data
	@{ nsd-gen scenes/paper/example1.json; \
	   nsd-gen scenes/paper/example1.json | nsd-step -m exact -n $(n_example1) $(limits_example1) --every 200 2> /dev/null; } | nsd-info -b | \
	    jq -r '[.position[0], .position[2], .radius, 2 * atan2(.orientation[2]; .orientation[0])] | @tsv' > $@

$(OUT)/figures/strobe.svg: $(OUT)/data/strobe.tsv $P/strobe.gp | $(OUT)/figures
	@gnuplot -e "data='$<'; out='$@'" $P/strobe.gp

# Example 1 in one frame, so that start and end show how far the ball went
view_example1    := --size 900x110 --camera 0,8 --box -0.01,0.24,-0.01,0.01,-0.001,0.012
view_example1-2d := --size 900x60 --box -0.01,0.24,-0.003,0.013
view = nsd-view $(or $(view_$*),--size $(if $(findstring -2d,$*),640x400,400x520)) 2> /dev/null

$(OUT)/figures/%-start.png: scenes/paper/%.json | $(OUT)/figures
	@nsd-gen $< | $(view) > $@

# The scene's own seed of example 2
end_run = $(OUT)/runs/$1_nsd_exact$(if $(filter example2%,$1),_9).h5
$(DIMS:%=$(OUT)/figures/%-end.png): $(OUT)/figures/%-end.png: $(OUT)/runs.json | $(OUT)/figures
	@$(view) $(call end_run,$*) > $@

# The pile goes on until it rests: warm and relaxed, for speed, and not as the paper has it
$(OUT)/rest/%.h5: $(OUT)/runs/%_nsd_exact.h5 | $(OUT)/rest
	@nsd-cat --last $< | nsd-step -m exact --protocol paper --tolerance 1e-6 --max-sweeps 5000 --warm --relax 1.5 --order colour \
	    -n $(n_rest) --every $(n_rest) -o $@ 2> /dev/null

$(OUT)/figures/%-rest.png: $(OUT)/rest/%.h5 | $(OUT)/figures
	@$(view) $< > $@

# How fast the bodies still are in those pictures
$(OUT)/tables/motion.tsv: $(OUT)/runs.json $(PILED_UP:%=$(OUT)/rest/%.h5) $P/motion.jq $P/stats.jq | $(OUT)/tables
	@{ printf 'scene\tpicture\tstep\ttime\tfastest\tmedian\n'; \
	   $(foreach s,$(PILED_UP),$(foreach f,end=$(call end_run,$s) rest=$(OUT)/rest/$s.h5, \
	       { nsd-info --last $(lastword $(subst =, ,$f)); nsd-info --last -b $(lastword $(subst =, ,$f)); } | \
	       jq -r -s -L $P -f $P/motion.jq --arg scene $s --arg picture $(firstword $(subst =, ,$f));)) } > $@

# ---- the page ----

PARTS := $(N:%=table%) seeds boxes same motion claims closed $(ADHESION)

$(OUT)/README.md: $P/page.md $P/page.awk $(PARTS:%=$(OUT)/tables/%.tsv) \
    $(SVG:%=$(OUT)/figures/%.svg) $(PNG:%=$(OUT)/figures/%.png)
	@awk -f $P/page.awk -v tables=$(OUT)/tables -v quick='$(QUICK)' $< > $@

$(addprefix $(OUT)/,adhesion adhesion-same adhesion-times runs same rest tables closed data history figures) \
$(addprefix $(OUT)/times/,0 $(rounds_example1) $(rounds_sweeps:%=sweeps-%)):
	@mkdir -p $@

# What a reader sees who runs nothing.
all-keep: all
	mkdir -p docs/paper
	rm -rf docs/paper/tables docs/paper/figures
	cp -r $(OUT)/README.md $(OUT)/runs.json $(OUT)/same.json $(OUT)/adhesion.json $(OUT)/adhesion-same.json $(OUT)/times.tsv $(OUT)/tables $(OUT)/figures docs/paper/

.PHONY: all all-keep
