# gallery.mk: the experiments of the gallery, and its page (make gallery).
#
#   OUT/E/picture.png, curve.png, result.json   of experiment E; with all it was made from
#   OUT/README.md                               the page
#
# What is there is not made again: to start afresh remove its folder. An experiment is three files in scripts/gallery:
# E.sh runs it, E.gp draws its curve, E.json has its title, text and table of what is published. SEEDS="1 2 3" says which
# random numbers it begins with.

QUICK ?=
OUT   ?= build/gallery$(if $(QUICK),-quick)
KEEP  ?= docs/gallery
P     := scripts/gallery
ALL   := $(patsubst $(P)/%.json,%,$(wildcard $(P)/*.json))
ONLY  ?= $(ALL)
# make takes a blank for the end of a name, the shell a quote for its own
$(if $(findstring ',$(OUT))$(word 2,$(OUT)),$(error gallery.mk: OUT=$(OUT): the name of the folder has a blank or a quote))
export PATH := $(CURDIR)/build:$(PATH)
export QUICK
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:

all: $(OUT)/README.md
	@echo "gallery: $(OUT)/README.md" >&2

$(OUT)/README.md: $(ONLY:%=$(OUT)/%/result.json) $(P)/page.jq $(ONLY:%=$(P)/%.json)
	jq -rs -L $(P) --argjson about "$$(jq -n '[inputs | {(input_filename | sub(".*/"; "") | rtrimstr(".json")): .}] | add' $(ONLY:%=$(P)/%.json))" \
	    -f $(P)/page.jq $(ONLY:%=$(OUT)/%/result.json) >$@

# what an experiment left half done is made anew
$(OUT)/%/result.json: $(P)/%.sh $(P)/%.json $(P)/common.sh $(P)/rows.jq
	@echo "gallery: $*" >&2
	rm -rf $(OUT)/$*
	$(P)/$*.sh $(OUT)/$*

# where readers find it: without the runs
keep: all
	rm -rf $(KEEP)
	for e in $(ONLY); do install -D -m 644 -t $(KEEP)/$$e $(OUT)/$$e/{picture.png,curve.png,result.json}; done
	install -m 644 $(OUT)/README.md $(KEEP)/README.md

.PHONY: all keep
