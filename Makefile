# The two commands: `make demo` shows what jali does, `make test` checks that it does. Both install what is
# missing (Debian packages; with sudo when not root) and build first. The others are for those who work on it:
#
#   make judge      outside judges (admesh, PrusaSlicer, manifold-3d, CalculiX)
#   make bench      times and memory, stage by stage        make pictures   draw docs/pictures again
#   make fuzz       each fuzzer for FUZZ_SECONDS            make format     lay the code out
#   make coverage   what the tests reach                    make lint       clang-tidy, cppcheck, layout
#   make docs       renew what the docs quote               make results    the tables of docs/results.md
PACKAGES := cmake ninja-build gcc g++ pkg-config libpng-dev libjpeg62-turbo-dev libwebp-dev librsvg2-dev \
            libcairo2-dev libdeflate-dev libzip-dev libexpat1-dev libjansson-dev libcmocka-dev \
            libopenblas-dev libmicrohttpd-dev
FUZZ_PACKAGES     := clang libclang-rt-dev
JUDGE_PACKAGES    := admesh prusa-slicer calculix-ccx
LINT_PACKAGES     := clang-format clang-tidy cppcheck
COVERAGE_PACKAGES := gcovr
PAGE_PACKAGES     := chromium

SUDO := $(shell [ "$$(id -u)" = 0 ] || echo sudo)
JOBS := $(shell nproc)
FUZZ_SECONDS ?= 60
BENCH ?=
# The thread sanitizer of gcc 12 cannot start under more than 28 bits of address randomisation.
FIXED_ADDRESSES := $(shell setarch -R true 2>/dev/null && echo setarch -R)

.PHONY: all page demo test packages release dev thread coverage judge bench results fuzz pictures docs format lint clean
all: release

# apt is asked only when a package is missing, so that a second run needs no network.
define install
	@missing=$$(for p in $(1); do \
	    dpkg-query -W -f='$${Status}' $$p 2>/dev/null | grep -q 'ok installed$$' || echo $$p; done); \
	if [ -n "$$missing" ]; then \
	    echo "installing:" $$missing; \
	    $(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive \
	        apt-get install -y -qq --no-install-recommends $$missing >/dev/null; \
	fi
endef

packages:
	$(call install,$(PACKAGES))

release dev thread: packages
	@cmake --preset $@ >/dev/null
	@cmake --build --preset $@ -j $(JOBS)

demo: release
	@tools/demo.sh build/release/jali out/demo

# The page is tried in a browser where there is a Node for it.
test: thread release dev
	$(if $(shell node -p 'Number(process.versions.node.split(".")[0]) >= 20 || ""' 2>/dev/null),$(call install,$(PAGE_PACKAGES)))
	@$(FIXED_ADDRESSES) ctest --preset thread --no-label-summary -j $(JOBS)
	@ctest --preset release --no-label-summary -j $(JOBS)
	@ctest --preset dev --no-label-summary -j $(JOBS)

judge: release
	$(call install,$(JUDGE_PACKAGES))
	@command -v npm >/dev/null || { $(SUDO) apt-get update -qq && $(SUDO) apt-get install -y -qq nodejs npm >/dev/null; }
	@tools/judge.sh build/release/jali build/judge

bench: release
	@build/release/bench/bench $(BENCH)

fuzz: packages
	$(call install,$(FUZZ_PACKAGES))
	@cmake --preset fuzz >/dev/null
	@cmake --build --preset fuzz -j $(JOBS)
	@tools/fuzz.sh build/fuzz build/corpus $(FUZZ_SECONDS)

# The page anew from web/src; what is committed serves those without Node.
page:
	@cd web && { [ -d node_modules/esbuild ] || npm ci --no-audit --no-fund --silent; } && npm run -s build

coverage: packages
	$(call install,$(COVERAGE_PACKAGES))
	@cmake --preset coverage >/dev/null
	@cmake --build --preset coverage -j $(JOBS)
	@ctest --preset coverage -j $(JOBS)
	@gcovr --root . --filter src/ --filter cli/ --filter serve/ build/coverage

pictures: release
	@tools/pictures.sh build/release/jali docs/pictures

# The tables of docs/results.md anew, from the pictures beside the project.
results: release
	@tools/results.sh build/release/bench

# Renew the blocks of docs/cli.md and docs/serve.md that show what the program says.
docs: release
	@for page in cli serve; do \
	    tools/help.sh build/release/jali docs/$$page.md >build/page.md && mv build/page.md docs/$$page.md; done

SOURCES = $(shell git ls-files '*.c' '*.h')

format:
	$(call install,$(LINT_PACKAGES))
	@clang-format -i $(SOURCES)

lint: release
	$(call install,$(LINT_PACKAGES))
	@tools/lint.sh build/release

clean:
	rm -rf build out
