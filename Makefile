# The commands a newcomer needs. Each one installs what is missing, builds what changed and then does its work:
# no other step is ever needed. `make help` lists them.

BIN := .venv/bin
OUT := out

.DEFAULT_GOAL := help
.PHONY: help render test test-long lint fuzz bench clean

help: ## list these commands
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

render: ## render the Cornell box to out/cornell-box.exr and .png
	@tools/bootstrap.sh build
	@mkdir -p $(OUT)
	@$(BIN)/accuray render scenes/cornell-box.toml -o $(OUT)/cornell-box.exr
	@echo "The picture is $(CURDIR)/$(OUT)/cornell-box.png"

test: ## run the tests (15 minutes at most on two cores)
	@tools/bootstrap.sh build test
	@$(BIN)/python -m pytest -m "not long"

test-long: ## run the tests that take long: planted bugs, convergence
	@tools/bootstrap.sh build test
	@$(BIN)/python -m pytest -m long

lint: ## check style, types, layers, sizes
	@tools/bootstrap.sh build test lint
	@tools/lint.sh

fuzz: ## read damaged files of every kind, FUZZ_SECONDS (600) each; clang is installed for it
	@tools/bootstrap.sh build fuzz
	@$(BIN)/python -m tests.fuzz

bench: ## measure speed and time-to-error, beside the peers that are installed
	@tools/bootstrap.sh build test
	@$(BIN)/python -m benchmarks

clean: ## remove everything that was built; the environments stay
	rm -rf build dist $(OUT) .pytest_cache .mypy_cache .ruff_cache .hypothesis
