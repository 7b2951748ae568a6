#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds everything with warnings as errors and runs all checks, the
# cheap ones first; the last thing printed is ctest's summary of the full run on the reference driver.
#   ./test.sh                    everything
#   ./test.sh CTEST_ARGUMENT...  one ctest run on the reference driver, for example ./test.sh -R sort
# COPPICE_DRIVER=auto|private|stock|system chooses the Vulkan driver, see host/setup.sh.
set -euo pipefail
source "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/host/setup.sh"

test_timeout=300 # seconds a test, where CMake sets no other
failed_checks=()

check() {
  local name=$1
  shift
  say "$name"
  "$@" || failed_checks+=("$name")
}

format_is_clean() {
  (
    cd "$root"
    find host kernels tests -name '*.h' -o -name '*.cpp' | sort |
      xargs -r -P "$(nproc)" -n 16 clang-format --dry-run --Werror
  )
}

# run_ctest FOLDER ARGUMENT...
run_ctest() {
  local folder=$1
  shift
  ctest --test-dir "$folder" --output-on-failure --no-tests=error --timeout "$test_timeout" \
    --parallel "$(nproc)" "$@"
}

# In a subshell, so that one driver's environment does not reach the next.
run_ctest_on() (
  use_driver "$1"
  shift
  run_ctest "$build_dir" "$@"
)

host_tests_sanitized() {
  UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 run_ctest "$build_dir/sanitize" -L host
}

install_missing "${build_packages[@]}" "${test_packages[@]}"
available_drivers
reference=${drivers[0]}

if (($#)); then
  build ci "$build_dir"
  run_ctest_on "$reference" "$@"
  exit
fi

check "format" format_is_clean
build ci "$build_dir"
build sanitize "$build_dir/sanitize" host_tests
check "host tests under AddressSanitizer and UndefinedBehaviorSanitizer" host_tests_sanitized
for driver in "${drivers[@]:1}"; do
  check "device tests on $(describe_driver "$driver")" run_ctest_on "$driver" -L device
done

# Said before the last run, because that one's summary closes the output.
for name in "${failed_checks[@]}"; do
  say "FAILED: $name"
done
say "all tests on $(describe_driver "$reference")"
run_ctest_on "$reference"
((${#failed_checks[@]} == 0))
