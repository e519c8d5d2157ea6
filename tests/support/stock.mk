# stock.mk: packings and problems that several tests use, made once for all of them, in build/stock. tap.sh's
# `stock NAME` asks for one. They are made again when a tool is.
S     := build/stock
TOOLS := $(wildcard build/nsd-gen build/nsd-step build/nsd-cat build/nsd-detect build/nsd-solve)
# two tests may make the same at a time: each makes a file of its own, and the last one stays
make   = @mkdir -p $S; { $1; } 2>$@.$$$$.said >$@.$$$$ || { cat $@.$$$$.said; exit 1; } && rm $@.$$$$.said && mv $@.$$$$ $@

$S/heap4.h5: $(TOOLS)
	$(call make,nsd-gen 4 | nsd-step -n 400 --every 400 | nsd-cat --last)
$S/solved4.h5: $S/heap4.h5
	$(call make,nsd-detect $< | nsd-solve)
$S/heap20.h5: $(TOOLS)
	$(call make,nsd-gen 20 | nsd-step -n 600 --every 600 --tolerance 1e-8 | nsd-cat --last)
# 60 balls fall, 30 frames
$S/run60.h5: $(TOOLS)
	$(call make,nsd-gen 60 | nsd-step -n 900 --every 30 --contacts)
# 500 balls at rest
$S/pile500.h5: $(TOOLS)
	$(call make,nsd-gen 500 | nsd-step -n 900 --every 900 --criterion natural --tolerance 1e-4 | nsd-cat --last)
