# wall.mk: what holds up the solvers on large piles, measured, and its page (make wall).
#
#   OUT/N/pile.h5           a pile of N balls, after 450 steps, or 1000 of 100 000 balls, in a box as wide as it is high, with its contacts
#   OUT/N/global.h5         its M, H, f, w and mu
#   OUT/N/sweeps-K.h5       after K sweeps
#   OUT/N/auto.h5           what nsd-solve finds
#   OUT/N/*.jsonl           what scripts/wall/wall.py makes of them
#   OUT/README.md, *.svg    the page
#
# What is there is not made again: to start afresh remove its folder.

QUICK ?=
OUT   ?= build/wall$(if $(QUICK),-quick)
KEEP  ?= docs/wall
P     := scripts/wall
SIZES := 500 $(if $(QUICK),,2000 8000)
LAST  := $(lastword $(SIZES))
EACH  := 1000 2000 4000 $(if $(QUICK),,8000 16000 32000 64000 128000 256000)# sweeps
END   := $(if $(QUICK),4000,64000)# where the law is made linear, and proximal steps begin
COUNT := $(if $(QUICK),20,60)# eigenvalues
EPS   := 1e-4 1e-5 1e-6 1e-7
LARGE := $(if $(QUICK),,32000 100000)# for the table of stiffnesses
SOFT  := $(if $(QUICK),0 1e-2,0 1e-4 1e-3 3e-3 1e-2 3e-2 1e-1)# compliances, of W
# make takes a blank for the end of a name, the shell a quote for its own
$(if $(findstring ',$(OUT))$(word 2,$(OUT)),$(error wall.mk: OUT=$(OUT): the name of the folder has a blank or a quote))
export PATH := $(CURDIR)/build:$(PATH)
export OMP_NUM_THREADS := 1
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.SECONDARY: $(foreach n,$(SIZES),$(EACH:%=$(OUT)/$n/sweeps-%.h5) $(OUT)/$n/pile.h5 $(OUT)/$n/global.h5 $(OUT)/$n/auto.h5)

all: $(OUT)/README.md
	@echo "wall: $(OUT)/README.md" >&2

$(OUT)/README.md: $(P)/page.py $(OUT)/map.svg $(OUT)/spectrum.svg $(SIZES:%=$(OUT)/%/spectrum.jsonl) $(OUT)/jam/follow.jsonl \
                  $(SIZES:%=$(OUT)/%/auto.jsonl) $(SIZES:%=$(OUT)/%/soft.jsonl) $(OUT)/stiffness.tsv $(OUT)/change.tsv
	$(P)/page.py $(OUT) $(SIZES) >$@

$(OUT)/%/pile.h5: $(P)/pile.jq
	@echo "wall: $*" >&2
	mkdir -p $(@D)
	jq -n --argjson n $* -f $(P)/pile.jq | nsd-gen - | nsd-step --criterion natural -n $(if $(filter 100000,$*),1000,450) --every 1000 2>$(@D)/step.log | nsd-cat --last | nsd-detect >$@

$(OUT)/%/global.h5: $(OUT)/%/pile.h5
	nsd-detect --fclib=global <$< >$@

# sweeps without mixing or relaxation, each a continuation of the one before
define sweeps
$$(OUT)/%/sweeps-$(1).h5: $$(OUT)/%/$(if $(2),sweeps-$(2),pile).h5
	nsd-solve --criterion natural --warm --solver nlgs -m exact --order colour --tolerance 1e-13 --max-sweeps $(if $(2),$$$$(($(1) - $(2))),$(1)) $$< >$$@ 2>/dev/null
endef
before :=
$(foreach k,$(EACH),$(eval $(call sweeps,$k,$(before)))$(eval before := $k))

$(OUT)/%/auto.h5: $(OUT)/%/pile.h5
	nsd-solve --criterion natural --tolerance 1e-8 $< >$@ 2>$(@D)/auto.log

$(OUT)/%/follow.jsonl: $(OUT)/%/global.h5 $(EACH:%=$(OUT)/\%/sweeps-%.h5) $(P)/wall.py
	$(P)/wall.py follow $< $(EACH:%=$(OUT)/$*/sweeps-%.h5) >$@

$(OUT)/%/auto.jsonl: $(OUT)/%/global.h5 $(OUT)/%/auto.h5 $(P)/wall.py
	$(P)/wall.py follow $(OUT)/$*/global.h5 $(OUT)/$*/auto.h5 | jq -c --slurpfile log <(nsd-info $(OUT)/$*/auto.h5) \
	    '. + ($$log[-1] | {sweeps})' >$@

$(OUT)/%/spectrum.jsonl: $(OUT)/%/global.h5 $(OUT)/%/sweeps-$(END).h5 $(P)/wall.py
	$(P)/wall.py spectrum $< $(OUT)/$*/sweeps-$(END).h5 $(COUNT) >$@

$(OUT)/%/steps.jsonl: $(OUT)/%/global.h5 $(OUT)/%/sweeps-$(END).h5 $(P)/wall.py
	$(P)/wall.py steps $< $(OUT)/$*/sweeps-$(END).h5 100 30 >$@

# with a stiffness
$(OUT)/%/soft.h5: $(OUT)/%/pile.h5
	nsd-step --stiffness 5.45e4 -n 300 --every 300 $< 2>/dev/null | nsd-cat --last >$@
$(OUT)/%/soft.jsonl: $(OUT)/%/soft.h5 $(P)/wall.py
	nsd-detect $< | nsd-solve --cold --criterion natural --tolerance 1e-10 >$(@D)/soft-solved.h5 2>/dev/null
	nsd-detect --fclib=global <$< >$(@D)/soft-global.h5
	$(P)/wall.py spectrum $(@D)/soft-global.h5 $(@D)/soft-solved.h5 $(COUNT) >$@
$(OUT)/stiffness.tsv: $(SIZES:%=$(OUT)/%/pile.h5) $(LARGE:%=$(OUT)/%/pile.h5) $(P)/stiffness.sh
	ALPHAS="$(SOFT)" $(P)/stiffness.sh $(foreach n,$(SIZES),$n=$(OUT)/$n/pile.h5) >$@
	$(if $(LARGE),ALPHAS="0 1e-3 3e-3 1e-2 1e-1" SOLVE_SECONDS=60 SECONDS_MOST=300 $(P)/stiffness.sh $(foreach n,$(LARGE),$n=$(OUT)/$n/pile.h5) >>$@)
$(OUT)/change.tsv: $(OUT)/$(LAST)/pile.h5 $(P)/change.sh $(P)/change.py
	ALPHAS="$(if $(QUICK),0 1e-2,0 1e-4 1e-3 1e-2)" $(P)/change.sh $< >$@

# step 217 of four balls of the paper's example 2, another seed: they wedge themselves in
$(OUT)/jam/jam.h5: scenes/paper/example2.json
	mkdir -p $(@D)
	jq '.seed = 7' $< | nsd-gen - | nsd-step --criterion natural -n 217 --overlap-rule keep 2>/dev/null | nsd-cat --frames 217 | nsd-detect --overlap-rule keep >$@
$(OUT)/jam/eps-%.h5: $(OUT)/jam/jam.h5
	nsd-solve --criterion natural --solver nlgs -m exact --tolerance $* --max-sweeps 1000000 $< >$@ 2>/dev/null
$(OUT)/jam/eps-auto.h5: $(OUT)/jam/jam.h5
	nsd-solve --criterion natural --tolerance 1e-10 $< >$@ 2>/dev/null
$(OUT)/jam/follow.jsonl: $(OUT)/jam/global.h5 $(EPS:%=$(OUT)/jam/eps-%.h5) $(OUT)/jam/eps-auto.h5 $(P)/wall.py
	$(P)/wall.py follow $< $(EPS:%=$(OUT)/jam/eps-%.h5) $(OUT)/jam/eps-auto.h5 >$@
$(OUT)/jam/global.h5: $(OUT)/jam/jam.h5
	nsd-detect --overlap-rule keep --fclib=global <$< >$@

$(OUT)/map.svg: $(P)/map.gp $(SIZES:%=$(OUT)/%/follow.jsonl) $(OUT)/$(LAST)/steps.jsonl
	for n in $(SIZES); do jq -r '[(.file | capture("sweeps-(?<k>[0-9]+)").k), .natural, .dv] | @tsv' $(OUT)/$$n/follow.jsonl; echo; echo; done >$(OUT)/follow.tsv
	for l in Coulomb held; do jq -r --arg l $$l 'select(.law == $$l) | [.step, .length] | @tsv' $(OUT)/$(LAST)/steps.jsonl; echo; echo; done >$(OUT)/steps.tsv
	gnuplot -e 'out = "$(OUT)"; sizes = "$(SIZES)"' $<

$(OUT)/spectrum.svg: $(P)/spectrum.gp $(SIZES:%=$(OUT)/%/spectrum.jsonl)
	for n in $(SIZES); do jq -r '.eigenvalues[] | @tsv' $(OUT)/$$n/spectrum.jsonl; echo; echo; done >$(OUT)/spectrum.tsv
	gnuplot -e 'data = "$(OUT)/spectrum.tsv"; out = "$@"; sizes = "$(SIZES)"' $<

# where readers find it: without the runs
keep: all
	rm -rf $(KEEP)
	install -D -m 644 -t $(KEEP) $(OUT)/README.md $(OUT)/map.svg $(OUT)/spectrum.svg $(OUT)/spectrum.tsv

.PHONY: all keep
