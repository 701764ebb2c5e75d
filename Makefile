# make demo [LOG=path] [OUT=demo]   packages, build, a map with picture and web page
# make test                         all that CI runs: build, tests, tiers, format, clang-tidy, sanitizers, install
# make help                         the rest
BUILD ?= build
OUT ?= demo
LOG ?=
PREFIX ?= /usr/local
JOBS ?= $(shell nproc)
PRODOMOS := $(BUILD)/apps/prodomos
PRODOMOS_DATASETS ?= ../shared/datasets
BENCH_LOGS ?= $(foreach log,intel driving_in_office fr079 ual_2014,$(PRODOMOS_DATASETS)/laser/$(log).rawlog)

.PHONY: help demo test build deps sanitize bench format tidy tiers install clean

help: ## what there is
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /\1|/' | \
	  while IFS='|' read -r name text; do printf '  make %-10s %s\n' "$$name" "$$text"; done

deps: ## install the packages that building and testing need
	@.ci/deps build run test lint

build: $(BUILD)/CMakeCache.txt ## build the program and the library
	cmake --build $(BUILD) -j $(JOBS)

$(BUILD)/CMakeCache.txt:
	@.ci/deps build
	cmake -S . -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release -DPRODOMOS_TESTS=OFF

demo: ## map a small building (or LOG=path): map file, picture, web page in OUT
	@.ci/deps build run
	@BUILD="$(BUILD)" OUT="$(OUT)" LOG="$(LOG)" JOBS="$(JOBS)" .ci/demo

test: ## everything that CI checks
	@.ci/deps build run test lint
	@JOBS="$(JOBS)" .ci/test

sanitize: ## the tests under address and undefined-behaviour sanitizers
	@JOBS="$(JOBS)" .ci/test sanitize

tidy: ## clang-tidy over src and apps
	@JOBS="$(JOBS)" .ci/test build tidy

tiers: ## who includes and links whom
	@.ci/check_tiers

format: ## clang-format the tree in place
	@.ci/sources | xargs -r clang-format -i

bench: ## the benchmarks of tests/bench
	@.ci/deps build test
	cmake -S . -B build-bench -G Ninja -DCMAKE_BUILD_TYPE=Release -DPRODOMOS_TESTS=OFF -DPRODOMOS_BENCHMARKS=ON
	cmake --build build-bench -j $(JOBS)
	@for log in $(BENCH_LOGS); do \
	  if [ -e "$$log" ]; then build-bench/tests/bench/bench_grid_insertion "$$log"; else echo "bench: $$log is absent, skipped"; fi; \
	done
	@if [ -e "$(firstword $(BENCH_LOGS))" ]; then tests/bench/replay_speed build-bench/apps/prodomos "$(firstword $(BENCH_LOGS))"; fi
	tests/bench/robustness build-bench "$(PRODOMOS_DATASETS)"

install: build ## install to PREFIX
	cmake --install $(BUILD) --prefix $(PREFIX)

clean: ## remove what building left
	rm -rf build build-*/ .cache/tidy
