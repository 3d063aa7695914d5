#!/usr/bin/env bash
# Prepares this checkout to run: system packages, uv, and .venv with AccuRay built into it.
#
#   tools/bootstrap.sh [GROUP...]     GROUP: dependency groups of pyproject.toml (default: build)
#
# The group fuzz also installs clang with the runtimes of libFuzzer and of its sanitizers.
#
# Every step looks first and does only what is missing, so a second run takes a moment and needs no network.
# On Debian and its relatives missing system packages are installed (as root, else by sudo); elsewhere this script
# says what to install and stops.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly MINIMUM_PYTHON=3.11
readonly MINIMUM_UV=0.8
readonly TOOLS=.venv-tools # holds uv where the machine has none

say() { printf '== %s\n' "$*" >&2; }
fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# --- What this machine has ----------------------------------------------------------------------------------------

has_command() { command -v "$1" >/dev/null 2>&1; }

# True if the compiler finds one of the given C++ headers.
has_header() {
  has_command g++ || return 1
  local test=0 header
  for header in "$@"; do test="$test || __has_include(<$header>)"; done
  printf '#if !(%s)\n#error missing\n#endif\n' "$test" | g++ -std=c++20 -x c++ -fsyntax-only - 2>/dev/null
}

python_is_new_enough() {
  has_command python3 && python3 -c "import sys; sys.exit(sys.version_info < (${MINIMUM_PYTHON/./, }))"
}
python_makes_venvs() { python3 -c 'import ensurepip, venv' 2>/dev/null; }
python_has_headers() {
  python3 -c 'import os, sys, sysconfig
sys.exit(not os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h")))' 2>/dev/null
}

# True if clang is here with libFuzzer and the sanitizers.
can_fuzz() {
  has_command clang++ || return 1
  local folder status=0
  folder=$(mktemp -d)
  printf 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }\n' >"$folder/a.cpp"
  clang++ -fsanitize=fuzzer,address,undefined "$folder/a.cpp" -o "$folder/a" 2>/dev/null || status=1
  rm -r "$folder"
  return "$status"
}

# Prints the Debian names of the packages that are missing, one per line.
missing_packages() {
  has_command g++ || echo g++
  has_command ccache || echo ccache
  has_header embree4/rtcore.h embree3/rtcore.h || echo libembree-dev
  has_header tbb/parallel_for.h || echo libtbb-dev
  has_header gtest/gtest.h || echo libgtest-dev
  has_command python3 || echo python3
  python_makes_venvs || echo python3-venv
  python_has_headers || echo python3-dev
}

# --- System packages ----------------------------------------------------------------------------------------------

readonly WHAT_TO_INSTALL="AccuRay needs, on any platform:
  a C++20 compiler (g++ 12 or later), make, ccache
  Python $MINIMUM_PYTHON or later with venv and its C headers
  Embree 3.13 or 4 and TBB with their headers (https://www.embree.org)
  GoogleTest, for the C++ tests
  clang with libFuzzer and its sanitizers, for make fuzz
Install them with your package manager, then run make again; on Debian and Ubuntu, make does it by itself."

apt_get() {
  if [ "$(id -u)" -eq 0 ]; then
    DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@" >&2
  else
    sudo DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@" >&2
  fi
}

# Installs the packages of Debian that are named.
apt_install() {
  has_command apt-get || fail "missing here: $* (Debian's names).
$WHAT_TO_INSTALL"
  [ "$(id -u)" -eq 0 ] || has_command sudo || fail "missing: $*. There is no sudo here, so run as root:
  apt-get install $*"

  say "installing system packages: $*"
  # The package lists are fetched only if the ones at hand do not do: they are absent or name files that are gone.
  apt_get install -y --no-install-recommends "$@" 2>/dev/null ||
    { apt_get update && apt_get install -y --no-install-recommends "$@"; } ||
    fail "apt-get could not install: $*"
}

install_system_packages() {
  local packages
  mapfile -t packages < <(missing_packages)
  [ "${#packages[@]}" -gt 0 ] || return 0
  apt_install "${packages[@]}"
  mapfile -t packages < <(missing_packages)
  [ "${#packages[@]}" -eq 0 ] || fail "still missing after their installation: ${packages[*]}.
$WHAT_TO_INSTALL"
}

# The runtimes are a package of their own, named for the version of clang.
install_fuzzer() {
  can_fuzz && return 0
  has_command clang++ || apt_install clang
  can_fuzz || apt_install "libclang-rt-$(clang++ -dumpversion | cut -d. -f1)-dev"
  can_fuzz || fail "clang++ does not link with -fsanitize=fuzzer,address,undefined.
$WHAT_TO_INSTALL"
}

# --- uv -----------------------------------------------------------------------------------------------------------

# True if the given uv command runs and is at least MINIMUM_UV.
uv_is_new_enough() {
  local version
  version=$("$1" --version 2>/dev/null | awk '{print $2}')
  [ -n "$version" ] && [ "$(printf '%s\n' "$MINIMUM_UV" "$version" | sort -V | head -n 1)" = "$MINIMUM_UV" ]
}

# Sets UV to a usable uv. One of our own goes into a private environment: Debian's Python allows no pip beside it.
find_uv() {
  local candidate
  for candidate in uv "$TOOLS/bin/uv"; do
    if uv_is_new_enough "$candidate"; then
      UV=$candidate
      return
    fi
  done
  say "installing uv into $TOOLS"
  python3 -m venv --clear "$TOOLS"
  echo '*' >"$TOOLS/.gitignore"
  "$TOOLS/bin/pip" install --quiet --disable-pip-version-check "uv>=$MINIMUM_UV"
  UV=$TOOLS/bin/uv
}

# --- The environment ----------------------------------------------------------------------------------------------

build_environment() {
  local sync=("$UV" sync --quiet --inexact --no-default-groups) group
  for group in "$@"; do sync+=(--group "$group"); done
  # Which Python: that of the environment if there is one already, else the machine's python3.
  [ -e .venv ] || export UV_PYTHON="${UV_PYTHON:-$(command -v python3)}"
  if ! "${sync[@]}" --check 2>/dev/null; then
    say "building AccuRay into .venv (a few minutes the first time)"
    UV_COMPILE_BYTECODE=1 "${sync[@]}"
  fi
  # Our own package lies outside .venv. Compiled here, the command starts fast even where Python may not write bytecode.
  .venv/bin/python -m compileall -q accuray
}

[ "$(uname -m)" = x86_64 ] || fail "AccuRay runs on x86-64 processors with AVX2, and this one is $(uname -m)."
install_system_packages
case " $* " in *" fuzz "*) install_fuzzer ;; esac
python_is_new_enough || fail "python3 is $(python3 --version 2>&1), but AccuRay needs $MINIMUM_PYTHON or later.
$WHAT_TO_INSTALL"
find_uv
build_environment "${@:-build}"
