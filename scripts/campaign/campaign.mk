# A campaign over mu and seeds, by make: make -j 8 -f campaign.mk SCENE=pile.json. What is killed goes on
# where it was: each run is a file, and a run that was cut off goes on from its last frame.
here  := $(shell dirname "$$(realpath "$(strip $(MAKEFILE_LIST))")")
MU    ?= 0.1 0.3 0.5 0.7
SEEDS ?= 1 2 3
SCENE ?= scene.json
UNTIL ?= 0.5
EVERY ?= 0.01s
export SCENE UNTIL EVERY

RUNS := $(foreach m,$(MU),$(foreach s,$(SEEDS),runs/mu-$m-seed-$s.h5))

all: campaign.png

$(RUNS): runs/%.h5: $(SCENE)
	"$(here)/run.sh" $(subst -seed-, ,$(patsubst mu-%,%,$*))

campaign.tsv: $(RUNS)
	"$(here)/table.sh" $^ > $@.part && mv $@.part $@

campaign.png: campaign.tsv
	gnuplot -e "table='$<'; picture='$@.part'" "$(here)/plot.gp" && mv $@.part $@
