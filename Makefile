# Everything that a user or a developer does, by name. scripts/setup.sh does the set-up and says what it changes.

SHELL := /bin/bash
BIN := $(or $(CARGO_TARGET_DIR),target)/release/luminaire
OLD_DRIVER := target/drivers/mesa-22.3.6/lvp_icd.json
VALIDATION := /usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json

LONG_FLAG := $(if $(LONG),--long)

.PHONY: help render gallery accuracy stability bench test fuzz setup build shaders lint

help: ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-9s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

render: setup ## render the Cornell box to out/cornell.png and out/cornell.exr, installing what is missing
	@mkdir -p out
	$(BIN) render scenes/cornell/cornell.toml -o out/cornell.png -o out/cornell.exr

gallery: setup ## render the pictures of docs/gallery.md again (fifty minutes on two cores without a GPU)
	scripts/gallery.sh

stability: setup ## run every stability sweep again: docs/stability.md (LONG=1: finer steps, about ten times as long)
	$(BIN) stability --out docs/stability --page docs/stability.md $(LONG_FLAG)

bench: setup ## measure speed against accuracy: out/bench/index.html (some minutes; LONG=1: about an hour; BASELINE=FILE.json: compare)
	@mkdir -p out
	$(BIN) bench --out out/bench $(LONG_FLAG) $(if $(BASELINE),--baseline $(BASELINE))

accuracy: setup ## measure the tables of docs/accuracy.md again (LONG=1: more samples, about ten times as long)
	cargo run --release --example accuracy -- $(LONG_FLAG)

test: ## install what the tests want, then run them all
	@scripts/setup.sh test
	@if [ -f $(OLD_DRIVER) ]; then export LUMINAIRE_OLD_DRIVER="$$PWD/$(OLD_DRIVER)"; fi; \
	if [ -f $(VALIDATION) ] || [ "$$LUMINAIRE_REQUIRE_GPU" = 1 ]; then export LUMINAIRE_VALIDATION=1; \
	else echo "SKIP: the Vulkan validation layer is not installed; its complaints are not tested"; fi; \
	echo cargo test --release --workspace; cargo test --release --workspace

fuzz: ## search for input that breaks the program: TARGET=obj, mtl, scene, ies, texture or part, for SECONDS=1200 (wants cargo-fuzz: docs/reliability.md)
	@mkdir -p fuzz/corpus/$(or $(TARGET),obj)
	cd fuzz && RUSTC_BOOTSTRAP=1 cargo fuzz run --sanitizer none $(or $(TARGET),obj) corpus/$(or $(TARGET),obj) seeds/$(or $(TARGET),obj) \
		-- -timeout=10 -rss_limit_mb=1024 -max_len=4096 -max_total_time=$(or $(SECONDS),1200)

setup: build ## build, and see to a Vulkan device
	@scripts/setup.sh vulkan

build: ## build the program
	@scripts/setup.sh build
	cargo build --release

shaders: ## compile shaders/*.comp to shaders/spirv/ again (wants glslc)
	scripts/build-shaders.sh

lint: ## format, clippy and documentation, without changing anything
	cargo fmt --all --check
	cargo clippy --release --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --release --workspace --no-deps --document-private-items
	@if command -v python3 > /dev/null; then python3 scripts/mutations.py --fit; \
	else echo "SKIP: python3 is not here; whether scripts/mutations.py fits the source is not checked"; fi
