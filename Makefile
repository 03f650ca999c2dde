# The two commands of the README are `make demo` and `make test`; the rest is for developers (CONTRIBUTING.md).
BUILD := build/release
JOBS ?= $(shell nproc)

.PHONY: build demo test test-hosts blender-addon setup setup-tests python-env clean pictures gallery reference site wheel test-wheel release build-time asan tsan fuzz tidy format
.DEFAULT_GOAL := build

setup:            ## installs the Debian packages muslin builds on, if any is missing
	@tools/setup

setup-tests:      ## and those that only the tests need: a browser, node, Python
	@tools/setup --tests

python-env: setup-tests   ## build/python-env, a virtual environment with what the Python module is built and tested with
	@tools/python_env build/python-env

$(BUILD)/build.ninja: CMakeLists.txt CMakePresets.json | setup
	cmake --preset release $(if $(CI),-DMUSLIN_WERROR=ON)

build: setup $(BUILD)/build.ninja   ## the program, at build/release/muslin
	cmake --build $(BUILD) -j $(JOBS) --target muslin_program

demo: build       ## runs the two-corner flag; movie, poster and a page for the browser under out/
	tools/demo $(BUILD)/muslin

test: python-env $(BUILD)/build.ninja    ## every test
	cmake $(BUILD) -DMUSLIN_BUILD_PYTHON=ON -DPython_EXECUTABLE=$(CURDIR)/build/python-env/bin/python
	cmake --build $(BUILD) -j $(JOBS)
	ctest --test-dir $(BUILD) -j $(JOBS) --output-on-failure

# Clang 16 or later.
CLANG ?= $(shell command -v clang++-19 || command -v clang++)

asan tsan:        ## every test under a sanitizer
	cmake --preset $@ -DCMAKE_CXX_COMPILER=$(CLANG)
	cmake --build build/$@ -j $(JOBS)
	ctest --preset $@ -j $(JOBS)

test-hosts: build ## the Blender add-on as an extension of 4.2, USD and Alembic: fetches the bpy module, 520 MB, once
	tools/test_bpy $(BUILD)/muslin

reference: $(BUILD)/build.ninja   ## pages made from the public headers, in build/release/reference/html; needs doxygen
	cmake --build $(BUILD) --target reference

site: setup       ## the documentation with search, in build/site
	@tools/setup --site
	@tools/python_env build/site-env docs/site/requirements.txt
	cmake --preset release $(if $(CI),-DMUSLIN_WERROR=ON)
	cmake --build $(BUILD) --target reference
	rm -rf build/site
	build/site-env/bin/sphinx-build -q -E -n -W --keep-going -c docs/site -d build/site-pages \
	  -D muslin_reference=$(BUILD)/reference . build/site
	@echo "open build/site/index.html"

build-time:       ## the processor time from a bare checkout to the program
	tools/build_time

blender-addon:    ## out/muslin-blender-VERSION.zip, for Blender 3.4 and later
	blender/package

wheel:            ## the Python module as wheels that hold everything, in out/wheels
	tools/wheel

test-wheel:       ## those wheels in bare systems, old and new; as root
	tools/test_wheel out/wheels/*.whl

release: build    ## the files of a release, in out/release
	tools/release $(BUILD)/muslin

FUZZ_SECONDS ?= 20

fuzz:             ## every fuzzer for FUZZ_SECONDS each; inputs that fail are left in build/
	cmake --preset fuzz -DCMAKE_CXX_COMPILER=$(CLANG)
	cmake --build build/fuzz -j $(JOBS) --target fuzzers
	tests/fuzz/run build/fuzz/tests/fuzz $(FUZZ_SECONDS)

tidy:             ## clang-tidy over the lines that have changed since TIDY_SINCE, or all
	tools/tidy $(TIDY_SINCE)

format:
	git ls-files '*.cpp' '*.hpp' | xargs clang-format -i

pictures: build setup-tests   ## the pictures of the README and the guides
	tools/make_pictures $(BUILD)/muslin

gallery: build    ## docs/gallery.md and the pictures that it lacks; `tools/gallery --film SCENE` makes movies
	tools/gallery --draw

clean:
	rm -rf build out
