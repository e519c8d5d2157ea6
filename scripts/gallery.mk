# gallery.mk: the experiments of the gallery (make gallery), the same by the independent code (make gallery-reference), and
# the page (make gallery-keep, make gallery-page).
#
#   OUT/E/picture.png, curve.png, result.json   of experiment E; with all it was made from
#   OUT/reference/E/result.json                 the same by bench/reference
#   KEEP/E/result.json, reference.json          what is kept of both
#   KEEP/table.json, KEEP/README.md             all rows, and the page
#
# What is there is not made again: to start afresh remove its folder. An experiment is three files in scripts/gallery:
# E.sh runs it, E.gp draws its curve, E.json has its title, text, options of nsd-step, parameters of the independent code
# (or why it has none) and the table of what is published. SEEDS="1 2 3" says which random numbers it begins with, PART
# which part of it is run.

QUICK ?=
OUT   ?= build/gallery$(if $(QUICK),-quick)
KEEP  ?= docs/gallery
P     := scripts/gallery
ALL   := $(patsubst $(P)/%.json,%,$(wildcard $(P)/*.json))
ONLY  ?= $(ALL)
# experiments that the independent code can express: their table says how
SOFT  := $(patsubst $(P)/%.json,%,$(shell grep -l '"reference": {' $(wildcard $(P)/*.json)))
# make takes a blank for the end of a name, the shell a quote for its own
$(if $(findstring ',$(OUT))$(word 2,$(OUT)),$(error gallery.mk: OUT=$(OUT): the name of the folder has a blank or a quote))
export PATH := $(CURDIR)/build:$(PATH)
export QUICK
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:

all: $(ONLY:%=$(OUT)/%/result.json)
	@echo "gallery: $(OUT)" >&2
reference: $(addprefix $(OUT)/reference/,$(addsuffix /result.json,$(filter $(SOFT),$(ONLY))))

# what an experiment left half done is made anew
$(OUT)/%/result.json: $(P)/%.sh $(P)/common.sh $(P)/rows.jq
	@echo "gallery: $*" >&2
	rm -rf $(OUT)/$*
	$(P)/$*.sh $(OUT)/$*

# the same by the independent code
$(OUT)/reference/%/result.json: $(P)/%.sh $(P)/common.sh $(P)/rows.jq build/reference/dem bench/reference/run.py
	@echo "gallery: $* by the independent code" >&2
	rm -rf $(OUT)/reference/$*
	CODE=reference $(P)/$*.sh $(OUT)/reference/$*

build/reference/dem: bench/reference/dem.c
	mkdir -p $(@D)
	$(CC) -O3 -march=native -ffast-math -o $@ $< -lm

# Results of OUT that are there, parts of experiments included, go to where readers find them; then the page
keep:
	for e in $(ONLY); do $(P)/keep.sh $(OUT)/$$e $(KEEP)/$$e result; $(P)/keep.sh $(OUT)/reference/$$e $(KEEP)/$$e reference; done
	$(MAKE) -f scripts/gallery.mk page KEEP=$(KEEP)

# table.json and README.md of what is kept: no run
by_name = jq -n '[inputs | {(.name // (input_filename | sub(".*/"; "") | rtrimstr(".json"))): .}] | add // {}' $(1) /dev/null
page:
	@about=$$($(call by_name,$(ONLY:%=$(P)/%.json))) results=$$($(call by_name,$(wildcard $(KEEP)/*/result.json))) \
	    references=$$($(call by_name,$(wildcard $(KEEP)/*/reference.json))); \
	with() { jq -L $(P) --argjson about "$$about" --argjson results "$$results" --argjson references "$$references" "$$@"; }; \
	with -n -f $(P)/table.jq >$(KEEP)/table.json; with -r -f $(P)/page.jq $(KEEP)/table.json >$(KEEP)/README.md

.PHONY: all reference keep page
