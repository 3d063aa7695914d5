#!/usr/bin/env bash
# All checks of style and structure, one after the other; every one runs, and the status is 1 if any of them fails.
# Called by `make lint`, which has put the tools into .venv.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly BIN=.venv/bin
readonly DATABASE=build/lint # compile_commands.json, for clang-tidy
failed=()

step() {
  local name=$1
  shift
  printf '== %s\n' "$name"
  "$@" || failed+=("$name")
}

# Configures the module and the tests without building them: clang-tidy needs to know how each file is compiled. SKBUILD
# is what the Python build sets.
configure() {
  PATH="$PWD/$BIN:$PATH" cmake -S . -B "$DATABASE" -G Ninja -DSKBUILD=ON -DACCURAY_TESTS=ON \
    -DPython_EXECUTABLE="$PWD/$BIN/python" -Dnanobind_DIR="$("$BIN/python" -m nanobind --cmake_dir)" >/dev/null
}

mapfile -t cpp < <(find src tests/fuzz -name '*.h' -o -name '*.cpp' -o -name '*.cu' | sort)
mapfile -t units < <(find src -name '*.cpp' | sort)

step 'ruff check' "$BIN/ruff" check --quiet .
step 'ruff format' "$BIN/ruff" format --quiet --check .
step 'mypy' "$BIN/mypy"
step 'layers' "$BIN/python" tools/check_layers.py
step 'sizes' "$BIN/python" tools/check_sizes.py
step 'leaks' "$BIN/python" tools/check_leaks.py
step 'clang-format' "$BIN/clang-format" --dry-run -Werror "${cpp[@]}"
step 'clang-tidy: configure' configure
step 'clang-tidy' xargs -P 2 -n 1 "$BIN/clang-tidy" -p "$DATABASE" --quiet --extra-arg=-Wno-unused-command-line-argument < <(printf '%s\n' "${units[@]}")

if [ "${#failed[@]}" -gt 0 ]; then
  printf '\nfailed: %s\n' "$(IFS=,; echo "${failed[*]}")"
  exit 1
fi
printf '\nall checks passed\n'
