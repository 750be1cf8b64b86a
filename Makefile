# The two commands: `make demo` shows what jali does, `make test` checks that it does. Both install what is
# missing (Debian packages; with sudo when not root) and build first.
PACKAGES := cmake ninja-build gcc pkg-config libpng-dev libjpeg62-turbo-dev libwebp-dev librsvg2-dev \
            libdeflate-dev libzip-dev libexpat1-dev libjansson-dev libcmocka-dev
FUZZ_PACKAGES  := clang libclang-rt-14-dev
JUDGE_PACKAGES := admesh prusa-slicer
SUDO := $(shell [ "$$(id -u)" = 0 ] || echo sudo)

.PHONY: all demo test packages release dev thread clean
all: release

# apt is asked only when a package is missing, so that a second run needs no network.
define install
	@missing=$$(for p in $(1); do dpkg-query -W -f='$${Status}' $$p 2>/dev/null | grep -q '^install ok' || echo $$p; done); \
	if [ -n "$$missing" ]; then echo "installing:" $$missing; \
	  $(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $$missing >/dev/null; fi
endef

packages:
	$(call install,$(PACKAGES))

release dev thread: packages
	@cmake --preset $@ >/dev/null
	@cmake --build --preset $@

test: release dev
	@ctest --preset dev
	@ctest --preset release

clean:
	rm -rf build out
