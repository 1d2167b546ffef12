# The front door. The work is done by CMake (CMakePresets.json), cmake/install_dependencies.sh and .ci/.
.DEFAULT_GOAL := help
.NOTPARALLEL:
JOBS ?= $(shell nproc)
PREFIX ?= /usr/local
SCENARIO ?= data/scenarios/four_bar_misaligned.json
RESULTS ?= build/results
STUDY ?= build/study
CTEST := ctest --test-dir build/release --output-on-failure --no-tests=error -j $(JOBS)
# What installs missing packages; "make NEED=true" leaves that out.
NEED := sh cmake/install_dependencies.sh

.PHONY: help run build test bench study stress gallery manual picture fuzz check-all dispatch deb install lint format clean

help:
	@echo "make run        install what is missing, build, simulate $(SCENARIO), write and draw $(RESULTS)"
	@echo "make build      install what is missing, build the library and the program in build/release"
	@echo "make test       build and run the unit and verification tests"
	@echo "make bench      build and run the benchmarks"
	@echo "make study      errors against run times of the standing set, one report with an index ($(STUDY)); two minutes"
	@echo "make stress     build and measure the stiff and extreme cases: build/stress/stress.html"
	@echo "make fuzz       a million inputs for what batches read, with sanitizers (clang; minutes)"
	@echo "make gallery    runs every scene of data/scenarios and data/gallery: build/gallery/index.html, with a view of each"
	@echo "make manual     renders data/manual by mkdocs: build/release/manual/site/index.html, and manual.html as one page"
	@echo "make picture    draws the moving picture of the README anew"
	@echo "make lint       format, include arrows, file lengths;  make format repairs the first"
	@echo "make check-all  everything: both compilers, slow tests, sanitizers, coverage, browser (an hour or more)"
	@echo "make dispatch   build one program for every x86-64 (build/dispatch) and test it; three times the time of build"
	@echo "make deb        a Debian package for every x86-64 in build/deb: program, library, Python, manual"
	@echo "make install    install into PREFIX ($(PREFIX)), with sudo only if the folder needs it"
	@echo "make clean      remove build/"
	@echo "Packages that are missing are listed, and then installed by apt-get, under sudo where that is needed."
	@echo "make NEED=true TARGET      installs none"

build/release/build.ninja:
	@$(NEED) build
	cmake --preset release -DBOUGH_BUILD_TESTS=OFF

build: build/release/build.ninja
	@$(NEED) build
	cmake --build build/release --parallel $(JOBS)

run: build/release/build.ninja
	@$(NEED) build
	cmake --build build/release --parallel $(JOBS) --target bough
	build/release/bough run $(SCENARIO) --out $(RESULTS) --replace --set /output/motion=true
	build/release/bough view $(RESULTS)
	@echo "Results in $(RESULTS):" && ls -1 $(RESULTS)

test:
	@$(NEED) build test
	cmake --preset release -DBOUGH_BUILD_TESTS=ON
	cmake --build build/release --parallel $(JOBS)
	$(CTEST) -L '^(unit|verification)$$'

stress: build
	build/release/bough stress --out build/stress --threads $(JOBS)

gallery: build
	python3 tests/tools/gallery.py build/release/bough build/gallery data/scenarios/*.json data/gallery/*.json

bench:
	@$(NEED) build bench
	cmake --preset bench
	cmake --build build/bench --parallel $(JOBS)
	sh benchmarks/run.sh build/bench

study: build
	build/release/bough study data/studies --out $(STUDY) --threads 2

manual: build
	@$(NEED) manual
	cmake --build build/release --target bough_manual

picture: build
	python3 data/manual/make/moving.py build/release/bough data/gallery/robot_arm.json data/manual/pictures/robot_arm.gif 0 2 40

fuzz:
	@$(NEED) build test asan
	cmake --preset asan
	cmake --build build/asan --parallel $(JOBS) --target fuzz_batch
	python3 tests/study/fuzz_batch.py build/asan/tests/fuzz_batch 1000000

lint:
	@$(NEED) lint
	sh tests/tools/lint.sh

format:
	@$(NEED) lint
	find include src apps tests benchmarks \( -name '*.hpp' -o -name '*.cpp' \) -print0 | xargs -0 clang-format-14 -i

check-all:
	@$(NEED) all
	.ci/check-all

dispatch:
	@$(NEED) build test
	cmake --preset dispatch
	cmake --build build/dispatch --parallel $(JOBS)
	ctest --test-dir build/dispatch --output-on-failure --no-tests=error -j $(JOBS)

# Under sudo only where a folder cannot be written; any other failure is one.
install: build
	@if command -v mkdocs >/dev/null; then cmake --build build/release --target bough_manual; \
	else echo "mkdocs is not there: the manual is installed as Markdown"; fi
	@if command -v python3 >/dev/null; then cmake --build build/release --target bough_shell; fi
	@may=yes; mkdir -p "$(PREFIX)" 2>/dev/null || may=no; \
	for folder in "$(PREFIX)" "$(PREFIX)"/bin "$(PREFIX)"/include "$(PREFIX)"/lib "$(PREFIX)"/share; do \
	  test ! -e "$$folder" || test -w "$$folder" || may=no; done; \
	if [ $$may = yes ]; then cmake --install build/release --prefix "$(PREFIX)"; \
	else echo "$(PREFIX) cannot be written by this user: installing under sudo"; \
	  sudo cmake --install build/release --prefix "$(PREFIX)"; fi

# Of the program for every x86-64, so that it may be passed on.
deb:
	@$(NEED) build test manual deb
	cmake --preset dispatch
	cmake --build build/dispatch --parallel $(JOBS)
	cmake --build build/dispatch --target bough_manual bough_shell
	cpack --config build/dispatch/CPackConfig.cmake -B build/deb
	@ls build/deb/*.deb

clean:
	rm -rf build
