# make            build everything        make check      set up, build, the tests of a user and of each change
# make demo       set up, build, 500 balls, a picture     make check-all  those and all others (tests/README.md)
# make install    PREFIX, DESTDIR         V=1: print the commands
# make bench      what it costs (bench/README.md)         make bench-compare   beside the last kept results
# make bench-solvers   all solvers over a collection of problems, Siconos' beside them
# make rest       what is done about overlap: columns and piles that rest (nsd-methods(7))
# make paper      every table and figure of the paper     QUICK=1        the same in minutes
# make wall       what holds up the solvers on large piles QUICK=1      one pile, in a minute
# make gallery    experiments beside what is published     QUICK=1       small, in minutes
# make gallery-reference   the same by an independent code; gallery-keep, gallery-page put both on the page
# make peers      seven jobs by nsd, LIGGGHTS and Yade    QUICK=1        small, in minutes
# make claims     what the pages claim, by the commands of tests/project/claims
# make site       all pages and manuals as HTML, build/site  make drawings  docs/drawings, from scripts/drawings
# make deb        Debian packages, in build/deb
#
# Objects, tools and tests are under build/; SAN=1 makes the same with ASan and UBSan in build/san/,
# at -O1: the sanitizers treble the code, and -O3 of that takes minutes.

VERSION := 2.0
# $(call Q,CC,FILE) before a command: a line that names the file instead of the command; V=1: the command
Q        = $(if $(V),,@printf '%-4s%s\n' $1 $2;)
PREFIX  ?= /usr/local
DESTDIR ?=
CC      ?= cc
CFLAGS  ?= $(if $(SAN),-O1 -g1,-O3 -g1)
B       := build$(if $(SAN),/san)
# The manuals that are made: of cookbook/, and of pages in man and the keys of scenes
COOKBOOK := build/man/nsd-cookbook.7
KEYED    := $(shell grep -l '^\.\\" keys ' man/*)
SCENE    := $(KEYED:%=build/%)

, := ,
# Debian's hdf5.pc is that of whichever flavour was installed last.
HDF5 := $(if $(shell pkg-config --exists hdf5-serial 2>/dev/null && echo 1),hdf5-serial,hdf5)
LIBS := $(HDF5) gsl jansson zlib libdeflate libpng cairo
PC   := $(shell pkg-config --cflags $(LIBS) 2>/dev/null)

# Archives of the libraries where there are some, of which a tool gets what it calls: shared ones load others,
# libhdf5 36 (libcurl and its own), CHOLMOD OpenBLAS, cairo X11, and a tool then starts in 10 ms of the
# processor instead of 2. SHARED=1: none, as distributions want it.
SHARED ?=
FOLDERS := $(dir $(shell $(CC) -print-file-name=libgsl.a 2>/dev/null)) $(patsubst -L%,%/,$(shell pkg-config --libs-only-L $(HDF5) 2>/dev/null))
library = $(firstword $(if $(SHARED),,$(foreach d,$(FOLDERS),$(wildcard $dlib$1.a))) -l$1)
# CHOLMOD's archive needs METIS, of which Debian has no link for compilers
METIS   := $(firstword $(foreach d,$(FOLDERS),$(wildcard $dlibmetis.so $dlibmetis.so.5)))
SPARSE  := $(if $(METIS),$(foreach l,klu btf cholmod camd ccolamd colamd amd suitesparseconfig,$(call library,$l)) $(METIS),-lklu -lcholmod)
# and qhull's has another name than its shared library
QHULL   := $(firstword $(if $(SHARED),,$(foreach d,$(FOLDERS),$(wildcard $dlibqhullstatic_r.a))) -lqhull_r)
PL      := $(foreach l,hdf5_hl hdf5 gsl gslcblas jansson,$(call library,$l)) $(SPARSE) $(QHULL) $(call library,cairo) \
           $(shell pkg-config $(if $(SHARED),,--static) --libs $(HDF5) cairo zlib libdeflate libpng 2>/dev/null) \
           $(foreach l,sz,$(if $(wildcard $(FOLDERS:%=%lib$l.so)),-l$l)) -lm

# And shared ones alone, for libnsd.so. GSL's own BLAS comes first: libcholmod loads one with other roundings, which would
# stand for it.
CBLAS       := -Wl,--push-state,--no-as-needed -lgslcblas -Wl,--pop-state
SHARED_LIBS := $(CBLAS) -lhdf5_hl -lklu -lcholmod -lqhull_r $(shell pkg-config --libs $(LIBS) 2>/dev/null) -lm

# No contraction to FMA: the same bytes on every machine.
NSD_CFLAGS  := -std=gnu11 -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wvla \
               -ffp-contract=off -fno-math-errno -pthread -DNSD_VERSION='"$(VERSION)"' -Ilib $(PC) \
               $(if $(SAN),-fsanitize=address$(,)undefined -fno-sanitize-recover=undefined)
# Only the libraries that a tool calls: starting libpng, KLU and CHOLMOD costs milliseconds.
NSD_LDFLAGS := -pthread -Wl,--as-needed $(if $(SAN),-fsanitize=address$(,)undefined)
NSD_LDLIBS  := $(if $(SHARED),$(CBLAS)) $(PL)

# The inner loops once a width; without contraction, and with instructions that the others know nothing of.
# Distributions build with -O2, at which gcc leaves loops over three components loops: three times the time.
WIDE      := sweep judge mixing small_sweep
WIDTHS    := 2 $(if $(filter x86_64,$(shell uname -m)),4 8)
WIDTH_4   := -mavx2
WIDTH_8   := -mavx512f -mavx512dq -mavx512vl
# Under the sanitizers the narrowest alone is instrumented: it is one text, the instrumented one takes minutes
# to compile and ten times as long to run, and make check runs the tests of solvers in that width, too.
SAN_WIDTH_2 := -fno-sanitize=null,alignment,object-size,pointer-overflow
SAN_WIDTH_4 := -fno-sanitize=all
SAN_WIDTH_8 := -fno-sanitize=all

# Tests build some tools again, by other compilers and sanitizers. WITHOUT: modules that those do not call; IDLE:
# widths that they do not run, but link: -O0 takes a second where -O1 takes ten.
WITHOUT ?=
IDLE    ?=

LIB   := $(patsubst lib/%.c,$B/lib/%.o,$(filter-out lib/run/main.c lib/mpi/%.c lib/run/mpi_processes.c $(WITHOUT:%=lib/%.c) $(WIDE:%=lib/solve/%.c),$(wildcard lib/*/*.c))) \
         $(foreach w,$(WIDE),$(WIDTHS:%=$B/lib/solve/$w-%.o))
# What programs of others call, lib/run/nsd.h, is in these objects; the linker takes what else they need from internal.a.
# Every object is hidden but for what that header declares; the archive has one object, in which the hidden names are local.
COMMAND_LINE := $(addprefix run/,cli completion loop partner options processes tool_filter)
PUBLIC := $(filter-out $(COMMAND_LINE:%=$B/lib/%.o),$(filter $B/lib/run/%,$(LIB)))
HIDDEN := -fPIC -fvisibility=hidden
SONAME := libnsd.so.2
TOOLS := $(patsubst tools/%.c,$B/%,$(wildcard tools/*.c))

# Where there are Open MPI, whose mpicc shows its flags, and Zoltan, nsd-step-mpi: what nsd-step becomes under
# mpirun. MPICC= : without.
MPICC  ?= mpicc
ZOLTAN := $(wildcard /usr/include/trilinos/zoltan.h)
MPI_PC := $(if $(and $(MPICC),$(ZOLTAN)),$(shell $(MPICC) --showme:compile 2>/dev/null))
MPI_LD := $(if $(MPI_PC),$(shell $(MPICC) --showme:link 2>/dev/null) -ltrilinos_zoltan)
# Its libhdf5 is the one that knows MPI, where that is there, and of the same version: ranks then write files
# together. PARALLEL= : the one of the other tools; the first rank then writes what the others send it.
PARALLEL ?= $(if $(MPI_PC),$(shell pkg-config --exists 'hdf5-openmpi = '$$(pkg-config --modversion $(HDF5)) 2>/dev/null && echo 1))
MPI_H5 := $(if $(PARALLEL),$(shell pkg-config --cflags-only-I hdf5-openmpi))
MPI_PL := $(if $(PARALLEL),$(subst hdf5/serial,hdf5/openmpi,$(PL)),$(PL))
RANKS  := $(if $(MPI_PC),$(patsubst lib/%.c,$B/lib/%.o,$(wildcard lib/mpi/*.c) lib/run/mpi_processes.c))
MPI    := $(if $(MPI_PC),$B/nsd-step-mpi)
CTEST := $(patsubst tests/%.c,$B/tests/%,$(wildcard tests/*/*_test.c))

all: $(TOOLS) $(MPI) $B/nsd-fit $B/libnsd.a $B/$(SONAME) $(COOKBOOK) $(SCENE)

$B/tests/unit/fclib_test: TESTLIBS += -lfclib

WRAPPED := $(patsubst %,$B/tests/hostile/%_test,failing_library_calls failing_library_calls_draw failing_library_calls_api changed_objects)
# The calls that tests/support/failing_library_calls.h makes fail: those of the library go through it.
FAILING := malloc calloc realloc strdup strndup malloc_trim H5Fcreate H5Fflush H5Fget_filesize H5Fget_file_image \
           H5Fget_vfd_handle H5Fset_libver_bounds H5LTopen_file_image H5Gcreate2 H5Lcreate_hard H5Oopen \
           H5Dcreate2 H5Dopen2 H5Dwrite H5Dread H5Dset_extent H5Dget_space H5Dget_type H5Dget_create_plist \
           H5Acreate_by_name H5Awrite H5Aread H5Aopen H5Aopen_by_name H5Aiterate2 H5Aget_space H5Aget_type \
           H5Tcopy H5Screate H5Screate_simple H5Fclose H5Gclose H5Dclose H5Aclose
$(WRAPPED): TESTLIBS += $(FAILING:%=-Wl,--wrap=%)
# Those of the libraries among themselves do not: these are shared ones here.
$(WRAPPED): NSD_LDLIBS := $(SHARED_LIBS)

$B/internal.a: $(LIB)
	$(call Q,AR,$@)rm -f $@ && ar rcs $@ $^

$B/nsd.o: $(PUBLIC) $B/internal.a
	$(call Q,LD,$@)$(LD) -r -o $@ $^ && objcopy --localize-hidden $@

$B/libnsd.a: $B/nsd.o
	$(call Q,AR,$@)rm -f $@ && ar rcs $@ $^

$B/$(SONAME): $(PUBLIC) $B/internal.a
	$(call Q,LD,$@)$(CC) -shared -Wl,-soname,$(SONAME) -Wl,-z,defs $(NSD_LDFLAGS) $(LDFLAGS) -o $@ $^ $(SHARED_LIBS)
	@ln -sf $(SONAME) $B/libnsd.so

$B/lib/%.o: lib/%.c Makefile
	@mkdir -p $(@D)
	$(call Q,CC,$<)$(CC) $(CPPFLAGS) $(NSD_CFLAGS) $(HIDDEN) $(CFLAGS) -MMD -MP -c -o $@ $<

# The page of nsd-web is part of the program.
$B/lib/draw/page.o: $(wildcard lib/draw/page/*)

# So are the kernels of a device, and the headers that they share with the CPU's.
$B/lib/solve/opencl_api.o: $(wildcard lib/solve/opencl/*.cl) lib/base/lanes.h $(wildcard lib/solve/local*.h) lib/solve/bundle.h

define compile_wide
$B/lib/solve/$1-%.o: lib/solve/$1.c Makefile
	@mkdir -p $$(@D)
	$$(call Q,CC,$$<)$$(CC) $$(CPPFLAGS) $$(NSD_CFLAGS) $$(HIDDEN) $$(CFLAGS:-O2=-O3) $(if $(SAN),$$(SAN_WIDTH_$$*)) -DLANES=$$* $$(WIDTH_$$*) $$(if $$(filter $$*,$$(IDLE)),-O0) -MMD -MP -c -o $$@ $$<
endef
$(foreach w,$(WIDE),$(eval $(call compile_wide,$w)))

$B/tools/%.o: tools/%.c Makefile
	@mkdir -p $(@D)
	$(call Q,CC,$<)$(CC) $(CPPFLAGS) $(NSD_CFLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

# The tool that is Python; the module is beside it: in python/, or installed.
$B/nsd-fit: tools/nsd-fit Makefile
	@mkdir -p $B
	@sed 's/@VERSION@/$(VERSION)/; s,"../python","$(CURDIR)/python",' $< >$@ && chmod 755 $@

$B/%: $B/tools/%.o $B/lib/run/main.o $B/internal.a
	$(call Q,LD,$@)$(CC) $(NSD_LDFLAGS) $(LDFLAGS) -o $@ $^ $(NSD_LDLIBS)

$B/tests/%: tests/%.c $B/internal.a Makefile
	@mkdir -p $(@D)
	$(call Q,CC,$<)$(CC) $(CPPFLAGS) $(NSD_CFLAGS) -Itests/support $(CFLAGS) -MMD -MP -o $@ $< $B/internal.a $(NSD_LDFLAGS) $(LDFLAGS) $(NSD_LDLIBS) $(TESTLIBS)

# run/mpi_processes.c stands for run/processes.c, which the archive then is not asked for.
$(RANKS): NSD_CFLAGS := $(MPI_H5) $(NSD_CFLAGS) $(MPI_PC)
$B/nsd-step-mpi: $B/tools/nsd-step.o $B/lib/run/main.o $(RANKS) $B/internal.a
	$(call Q,LD,$@)$(CC) $(NSD_LDFLAGS) $(LDFLAGS) -o $@ $^ $(MPI_PL) $(MPI_LD)

tests: $(TOOLS) $(MPI) $B/nsd-fit $(CTEST) $B/libnsd.a $B/$(SONAME) $(COOKBOOK) $(SCENE)

# ---- set-up, checks, the demonstration ----

setup-run setup-wall setup-reference setup-site setup-check setup-all:
	scripts/setup.sh $(@:setup-%=%)

# tests/README.md has the table of the two tiers. scripts/prove.sh runs the files, the longest first: one that
# begins last leaves a core idle while it ends.
FIRST := $(patsubst %,tests/%.t,tools/outside tools/examples whole/laws whole/solvers hostile/wrong_input whole/shapes tools/stat tools/types \
         tools/export tools/grains tools/view tools/pipeline tools/walls) $B/tests/unit/shapes_test
# What make check leaves to make check-all: it builds again, needs what only a maintainer has, or takes minutes.
REST  := $(patsubst %,tests/%.t,project/lint whole/paper project/compilers whole/gallery project/thread_sanitizer whole/mpi whole/mpi_small whole/device \
         project/fresh_machine project/install whole/wall whole/paper_page whole/cookbook tools/web_in_browser hostile/failing_system_calls hostile/failing_allocations) \
         $(patsubst %,$B/tests/hostile/%_test,failing_library_calls failing_library_calls_draw failing_library_calls_api killed_writer)
TESTS := $(FIRST) $(filter-out $(FIRST) $(REST),$(CTEST) $(wildcard tests/*/*.t))
# What the sanitizers would not see more of: it looks at texts, or makes others' experiments.
PLAIN := $(filter-out tests/whole/mpi.t tests/whole/mpi_small.t tests/whole/wall.t tests/tools/% tests/hostile/% $B/tests/%,$(REST)) $(patsubst %,tests/%.t,project/layers project/docs project/claims project/site project/english project/readme project/symbols tools/examples tools/campaign tools/fit whole/rest)
# What looks into inner loops has, under the sanitizers, those of the width that is instrumented.
NARROW := $(if $(SAN),$(patsubst %,$B/tests/unit/%_test,laws local shapes solver step))

PROVE := PATH="$(CURDIR)/$B:$$PATH" scripts/prove.sh

# make test: the tests of make check, of what is built; SAN=1: all that the sanitizers run
test: tests
	$(PROVE) $(filter-out $(NARROW) $(if $(SAN),$(PLAIN)),$(TESTS) $(if $(SAN),$(REST)))
	$(if $(NARROW),NSD_LANES=2 $(PROVE) $(NARROW))

# The whole of a test of which make check runs a part is there, too; and one that needs a package of setup-all.
test-rest: tests
	NSD_DEEP=1 $(PROVE) $(REST) tests/hostile/wrong_input.t $B/tests/unit/api_test tests/tools/fit.t

check: setup-check
	$(MAKE) -j2 tests
	$(MAKE) test

# All that make check leaves out; loops are thinned under ASan and UBSan.
check-rest: setup-all
	$(MAKE) -j2 tests
	$(MAKE) -j2 SAN=1 tests
	NSD_THIN=1 $(MAKE) SAN=1 test
	$(MAKE) fuzz-corpus
	$(MAKE) test-rest

check-all: check
	$(MAKE) check-rest

demo: setup-run
	@echo 'building, some two minutes:'
	@bash -o pipefail -c "$(MAKE) --no-print-directory -j2 all | awk -f scripts/count.awk"
	@PATH="$(CURDIR)/build:$$PATH" scripts/demo.sh

# scripts/paper.mk says what is made; paper-keep puts it where readers find it, docs/paper.
paper paper-keep: setup-run
	$(MAKE) -j2 all
	$(MAKE) -f scripts/paper.mk $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc)) $(@:paper%=all%)
	$(if $(filter paper-keep,$@),PATH="$(CURDIR)/$B:$$PATH" prove tests/whole/paper_page.t)

# scripts/wall.mk says what is measured; wall-keep puts the page into docs/wall.
wall wall-keep: setup-wall
	$(MAKE) all
	$(MAKE) -f scripts/wall.mk $(if $(filter wall-keep,$@),keep,all)

# scripts/gallery.mk says what is run; gallery-reference runs it by the independent code, gallery-keep puts results into docs/gallery.
gallery: setup-run
gallery-reference: setup-reference
gallery gallery-reference:
	$(MAKE) -j2 all
	$(MAKE) -f scripts/gallery.mk $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc)) $(if $(filter gallery,$@),all,reference)
gallery-keep gallery-page:
	$(MAKE) -f scripts/gallery.mk $(@:gallery-%=%)

# bench/peers/jobs.py says what is run; peers-keep puts the page into docs/peers. ARGS: options of bench/peers.py
peers peers-keep: setup-wall
	$(MAKE) -j2 all
	PATH="$(CURDIR)/$B:$$PATH" bench/peers.py $(if $(QUICK),--quick) --mode cost,$(if $(QUICK),,check$(,)effort$(,)rest$(,)growth$(,)profile$(,))$(if $(filter peers-keep,$@),keep,page) $(ARGS)

bench: all
	bench/run.sh
	bench/whole.sh
	bench/sweeps.sh
	bench/problems.sh

# Every solver over every FCLIB problem, Siconos' beside nsd's; ONLY=nsd: that half again
bench-solvers: all
	bench/solvers.sh

# What each way against overlap does to what rests
rest: all
	bench/rest.sh

# What make bench left beside what was kept before
bench-compare:
	bench/compare.sh

# ---- hostile input ----

# Targets of clang's libFuzzer, SECONDS each; what they find new stays in build/fuzz/corpus.
SECONDS := 600
FUZZ    := document problem scene mesh import
FUZZCC  := clang
FUZZSAN := -fsanitize=address,undefined -fno-sanitize-recover=undefined
F       := build/fuzz
# nsd's own readers and what solves: not the command line, nor what draws and exports
NOT_READ := $(COMMAND_LINE) $(addprefix convert/,fields_file format gsd lammps sheet sheet_walls stl text vtk xyz)
FLIB    := $(patsubst $B/%,$F/%,$(filter-out $B/lib/draw/% $(NOT_READ:%=$B/lib/%.o),$(LIB)))

$F/lib/%.o: lib/%.c
	@mkdir -p $(@D)
	$(FUZZCC) $(CPPFLAGS) $(NSD_CFLAGS) -O1 -g1 $(FUZZSAN) -fsanitize=fuzzer-no-link -MMD -MP -c -o $@ $<

# No bytes of a file come here but as checked numbers: without the sanitizers, which take minutes to build, and
# without optimisation, which would take longer than all that the few contacts of a file need.
define fuzz_wide
$F/lib/solve/$1-%.o: lib/solve/$1.c Makefile
	@mkdir -p $$(@D)
	$$(FUZZCC) $$(CPPFLAGS) $$(NSD_CFLAGS) -O0 -DLANES=$$* $$(WIDTH_$$*) -MMD -MP -c -o $$@ $$<
endef
$(foreach w,$(WIDE),$(eval $(call fuzz_wide,$w)))

$F/fuzz_%: tests/hostile/fuzz/fuzz_%.c tests/hostile/fuzz/child.c $(FLIB) Makefile
	@mkdir -p $(@D)
	$(FUZZCC) $(CPPFLAGS) $(NSD_CFLAGS) -O1 -g1 $(FUZZSAN) -fsanitize=fuzzer -Itests/hostile/fuzz -o $@ \
	    $< tests/hostile/fuzz/child.c $(FLIB) $(NSD_LDFLAGS) $(LDFLAGS) $(NSD_LDLIBS)

fuzz: $(FUZZ:%=$F/fuzz_%)
	tests/hostile/fuzz/run.sh $(SECONDS) $(FUZZ)

# The kept corpus once, as a test, by the library that has the sanitizers already
$B/tests/hostile/fuzz_%: tests/hostile/fuzz/fuzz_%.c tests/hostile/fuzz/replay.c tests/hostile/fuzz/child.c $B/internal.a
	@mkdir -p $(@D)
	$(call Q,CC,$<)$(CC) $(CPPFLAGS) $(NSD_CFLAGS) $(CFLAGS) -Itests/hostile/fuzz -o $@ $^ $(NSD_LDFLAGS) $(LDFLAGS) $(NSD_LDLIBS)

corpus: $(FUZZ:%=$B/tests/hostile/fuzz_%)

fuzz-corpus:
	$(MAKE) -j2 SAN=1 corpus
	for t in $(FUZZ); do ASAN_OPTIONS=detect_leaks=0:handle_segv=0:allocator_may_return_null=1 \
	    build/san/tests/hostile/fuzz_$$t tests/hostile/fuzz/corpus/$$t/* || exit 1; done

# Branches that the tests take, by folder (gcovr); below the bounds it fails. What is inlined counts once.
# Not in make check: it builds everything again and takes a quarter of an hour.
COVERAGE_FLAGS := -O2 -g -fno-early-inlining -fno-tree-vectorize --coverage -DNSD_COVERAGE \
                  -fprofile-update=prefer-atomic
COVERAGE_TESTS := $(wildcard tests/tools/*.t tests/whole/*.t tests/hostile/*.t)
coverage:
	$(MAKE) -j2 CFLAGS="$(COVERAGE_FLAGS)" LDFLAGS=--coverage B=build/coverage tests
	find build/coverage -name '*.gcda' -delete
	-PATH="$(CURDIR)/build/coverage:$$PATH" NSD_THIN=1 NSD_RUNS=100 prove -j2 build/coverage/tests/*/*_test $(COVERAGE_TESTS)
	scripts/coverage.sh build/coverage

# Lists of prerequisites come with the objects: make shall not look for ways to make them (sweep-8.d from
# sweep-8.d.o, which it compiles with LANES=8.d, each time).
%.d: ;
-include $(wildcard $F/lib/*/*.d)
.PHONY: fuzz fuzz-corpus corpus coverage

# ---- style ----

SOURCES := $(wildcard lib/*/*.[ch] tools/*.c docs/*.c docs/examples/*.c bench/*.c tests/*/*.[ch])
SCRIPTS := $(wildcard scripts/*.sh scripts/man/*.sh scripts/readme/*.sh scripts/site/*.sh bench/*.sh docs/examples/*.sh tests/*/*.sh tests/*/*.t) .ci/run

format:
	clang-format -i $(SOURCES)

lint: lint-format lint-manuals lint-scripts lint-cppcheck lint-tidy

lint-format:
	clang-format --dry-run --Werror $(SOURCES)

lint-manuals: $(COOKBOOK) $(SCENE)
	mandoc -T lint -W warning $(MANUALS)

lint-scripts:
	shellcheck $(SCRIPTS)
	shellcheck -s bash -S warning -x $(wildcard cookbook/*/*.sh scripts/gallery/*.sh)

# With the names by which compilers for this machine choose between texts; of all combinations, which nobody
# compiles, cppcheck would look at twelve. Then what is compiled for wider vectors.
CPPCHECK := cppcheck --quiet --error-exitcode=1 --std=c11 --enable=warning,performance,portability \
            --inline-suppr --suppress=missingIncludeSystem -D__x86_64__ -D__SSE2__ -Ilib

lint-cppcheck:
	$(CPPCHECK) lib tools
	$(CPPCHECK) -D__AVX__ -DLANES=4 $(WIDE:%=lib/solve/%.c)
	$(CPPCHECK) -D__AVX__ -DLANES=8 $(WIDE:%=lib/solve/%.c)

TIDY := $(sort $(patsubst %.c,lint-tidy-%,$(notdir $(filter-out $(if $(MPI_PC),,lib/mpi/% lib/run/mpi_processes.c),$(wildcard lib/*/*.c tools/*.c)))))

# STATES: how many states of a function the analyzer looks at, if not its own 225000
STATES ?=

lint-tidy: $(TIDY)

$(TIDY): lint-tidy-%:
	clang-tidy --quiet $(wildcard lib/*/$*.c tools/$*.c) -- -std=gnu11 -DNSD_VERSION='"$(VERSION)"' \
	    -Ilib $(PC) $(MPI_PC:-I%=-isystem %) $(STATES:%=-Xclang -analyzer-config -Xclang max-nodes=%) 2>/dev/null

# ---- what is made for others ----

MANUALS := $(filter-out $(KEYED),$(wildcard man/*)) $(COOKBOOK) $(SCENE)

# nsd-cookbook(7) is made of cookbook/*/, whatever recipes there are
$(COOKBOOK): scripts/man/cookbook.sh $(wildcard cookbook/* cookbook/*/*)
	@mkdir -p $(@D)
	$(call Q,MAN,$@)scripts/man/cookbook.sh $(wildcard cookbook/*/) > $@

# Keys of scenes are those that nsd-gen knows
$(SCENE): build/man/%: man/% $(KEYED) scripts/man/keys.sh $B/nsd-gen
	@mkdir -p $(@D)
	$(call Q,MAN,$@)PATH=$(CURDIR)/$B:$$PATH scripts/man/keys.sh $< > $@

# What the pages claim, the slow ones too
claims: all
	NSD_CLAIMS=all $(PROVE) tests/project/claims.t

# All pages, manuals and recipes as static HTML, by scripts/site/site.py; docs: its former name
docs site: setup-site $(MANUALS)
	scripts/site/site.py $B/site $(MANUALS)
	@echo "site: $B/site/index.html" >&2

# The drawings of the manuals, SVG in docs/drawings
drawings:
	scripts/drawings/make.py docs/drawings

manuals-list: $(MANUALS)
	@echo $^

# The manuals as pages that forges show, which README.md links to
manuals-keep: setup-site $(MANUALS)
	scripts/man/rendered.py docs/manual $(MANUALS)

# Completion in bash and zsh, out of each tool's table of options
COMPLETIONS := $(foreach t,$(notdir $(TOOLS)) nsd-fit,$B/completion/bash/$t $B/completion/zsh/_$t)

completions: $(COMPLETIONS)

$B/completion/bash/%: $B/%
	@mkdir -p $(@D)
	$< --completion bash > $@

$B/completion/zsh/_%: $B/%
	@mkdir -p $(@D)
	$< --completion zsh > $@

# ---- installation ----

LIBDIR ?= $(PREFIX)/lib
TO     := $(DESTDIR)$(PREFIX)

install: install-tools install-lib install-dev install-python

install-tools: all completions
	install -d $(TO)/bin $(addprefix $(TO)/share/man/man,1 5 7) $(TO)/share/nsd/scenes/paper \
	    $(TO)/share/bash-completion/completions $(TO)/share/zsh/site-functions
	install -m 755 $(TOOLS) $(MPI) $(TO)/bin
	for m in $(filter-out $(PYTHON_MANUALS) %.3,$(MANUALS)); do install -m 644 $$m $(TO)/share/man/man$${m##*.}; done
	install -m 644 scenes/*.json $(TO)/share/nsd/scenes
	install -m 644 scenes/paper/*.json $(TO)/share/nsd/scenes/paper
	for d in $(patsubst %/about,%,$(wildcard cookbook/*/about)); do install -d $(TO)/share/nsd/$$d && \
	    install -m 644 $$d/* $(TO)/share/nsd/$$d && chmod 755 $(TO)/share/nsd/$$d/*.sh || exit 1; done
	install -d $(TO)/share/nsd/campaign
	install -m 755 scripts/campaign/*.sh scripts/campaign/*.sbatch $(TO)/share/nsd/campaign
	install -m 644 scripts/campaign/*.mk scripts/campaign/*.gp $(TO)/share/nsd/campaign
	install -m 644 $B/completion/bash/* $(TO)/share/bash-completion/completions
	install -m 644 $B/completion/zsh/* $(TO)/share/zsh/site-functions

install-lib: $B/$(SONAME)
	install -d $(DESTDIR)$(LIBDIR)
	install -m 644 $B/$(SONAME) $(DESTDIR)$(LIBDIR)/$(SONAME).0
	ln -sf $(SONAME).0 $(DESTDIR)$(LIBDIR)/$(SONAME)

# What a program with the library is built by: its only header, the archive, the link for compilers
install-dev: $B/libnsd.a
	install -d $(DESTDIR)$(LIBDIR)/pkgconfig $(TO)/include $(TO)/share/man/man3
	install -m 644 lib/run/nsd.h $(TO)/include
	install -m 644 $B/libnsd.a $(DESTDIR)$(LIBDIR)
	ln -sf $(SONAME) $(DESTDIR)$(LIBDIR)/libnsd.so
	install -m 644 man/nsd.3 $(TO)/share/man/man3
	install -d $(TO)/share/doc/nsd/examples
	install -m 644 docs/step.c docs/examples/* $(TO)/share/doc/nsd/examples
	sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|; s|@HDF5@|$(HDF5)|' nsd.pc.in \
	    > $(DESTDIR)$(LIBDIR)/pkgconfig/nsd.pc
	chmod 644 $(DESTDIR)$(LIBDIR)/pkgconfig/nsd.pc

# Where python3 looks, where PREFIX is /usr; elsewhere PYTHONPATH names it.
PYTHONDIR     ?= $(PREFIX)/lib/python3/dist-packages
PYTHON_MANUALS := man/nsd-python.7 man/nsd-fit.1
install-python:
	install -d $(DESTDIR)$(PYTHONDIR)/nsd/fit $(addprefix $(TO)/share/man/man,1 7) $(TO)/bin
	install -m 644 python/nsd/*.py python/nsd/py.typed $(DESTDIR)$(PYTHONDIR)/nsd
	install -m 644 python/nsd/fit/*.py $(DESTDIR)$(PYTHONDIR)/nsd/fit
	sed 's/@VERSION@/$(VERSION)/; s,"../python"\, ,,' tools/nsd-fit >$(TO)/bin/nsd-fit && chmod 755 $(TO)/bin/nsd-fit
	for m in $(PYTHON_MANUALS); do install -m 644 $$m $(TO)/share/man/man$${m##*.}; done

uninstall:
	cd $(TO)/bin && rm -f $(notdir $(TOOLS)) nsd-step-mpi nsd-fit
	for m in $(MANUALS); do rm -f $(TO)/share/man/man$${m##*.}/$${m##*/}; done
	for t in $(notdir $(TOOLS)) nsd-fit; do \
	    rm -f $(TO)/share/bash-completion/completions/$$t $(TO)/share/zsh/site-functions/_$$t; \
	done
	rm -rf $(TO)/share/nsd $(TO)/share/doc/nsd $(TO)/include/nsd.h $(DESTDIR)$(PYTHONDIR)/nsd
	rm -f $(addprefix $(DESTDIR)$(LIBDIR)/,libnsd.a libnsd.so $(SONAME) $(SONAME).0 pkgconfig/nsd.pc)

# Debian packages in build/deb, of a copy of the sources: nsd-tools; libnsd2, and libnsd-dev for programs; python3-nsd
deb:
	scripts/deb.sh

clean:
	rm -rf build demo

-include $(wildcard $B/lib/*/*.d $B/tools/*.d $B/tests/*/*.d)

PARTS := format manuals scripts cppcheck tidy
.PHONY: all tests test check demo paper paper-keep wall wall-keep gallery gallery-reference gallery-keep gallery-page peers peers-keep bench bench-solvers bench-compare rest format lint $(PARTS:%=lint-%) $(TIDY) docs site drawings manuals-list manuals-keep completions install install-tools install-lib install-dev install-python uninstall deb clean setup-run setup-wall setup-reference setup-site setup-check setup-all test-rest check-rest check-all
.SECONDARY:
