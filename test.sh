#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds everything by g++ and by clang with warnings as errors and runs all
# checks, the cheap ones first. The first that fails ends it, so what it said stands last; when all pass, that is ctest's
# summary of the full run on the reference driver. Before that run a table says how long each part took.
#   ./test.sh                    everything
#   ./test.sh CTEST_ARGUMENT...  one ctest run on the reference driver, each test by itself, for example
#                                ./test.sh -R Sort
# COPPICE_DRIVER=auto|private|stock|system chooses the Vulkan driver, see host/setup.sh.
# COPPICE_FUZZ_SECONDS: how long each reader is fuzzed, thousands of inputs unless given; COPPICE_FUZZ_SEED: another seed.
set -euo pipefail
source "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/host/setup.sh"

test_timeout=600 # seconds a process of tests, where CMake sets no other
# Long, and of a driver that is not the reference they would say little more than the rest: sizes, times, options. And
# tests in which a sort by lookback sums up tiles that are late: old lavapipe ends loops by itself, so there the outcome
# would hang on how late they are; by default its sort has no lookback. And what only GPUs run.
reference_only='AMillion|EveryStageOfEveryTree|WideTree.PowersOfTwo|WideTree.SizesUpTo300|BenchChecksAndTimes'
reference_only+='|TuneKeeps|TuneWithout|NamesMayHoldAnything|AFullDisk|IsNotWaitedFor|OptionsDoWhatTheySay'
reference_only+='|OutputsThatCome|SeedsInARow|AboutSixtyFourTilesOfASort|LikeAGpu'
# Of the trees that are traced, left are one without split triangles and one with, and the device's; in the other scene,
# and beside brute force, one tree.
reference_only+='|DeviceTraceOf.*/(bottom_up|gd16|gd16_early|hploc|lbvh|ploc_parallel|sah|sah_sweep|top_down)$'
reference_only+='|DeviceTraceOf(\.Scatter|Tree).*/(gpu_hploc|gpu_lbvh|ploc|sbvh)$'

# timed NAME COMMAND...: notes how long it took.
parts=()
timed() {
  local name=$1 start=$SECONDS
  shift
  "$@" || return # also where errexit is off, as before a ||
  parts+=("$(printf '%6d s  %s' "$((SECONDS - start))" "$name")")
}

check() {
  local name=$1
  shift
  say "$name (after $SECONDS s)"
  timed "$name" "$@" || die "FAILED: $name"
}

say_times() {
  say "$SECONDS s so far:"
  printf '%s\n' "${parts[@]}" >&2
}

format_is_clean() {
  (
    cd "$root"
    find host kernels tests -name '*.h' -o -name '*.cpp' | sort |
      xargs -r -P "$(nproc)" -n 16 clang-format --dry-run --Werror
  )
}

# Of ctest's last run, whose processes hold many tests, those that failed, that began and said nothing of their end, or
# that were skipped.
name_tests_of_last_run() {
  awk '
    function name() { match($0, /\] [^ ,]+/); return substr($0, RSTART + 2, RLENGTH - 2) }
    /\[ RUN      \] / { running = name() }
    /\[       OK \] |\[  FAILED  \] |\[  SKIPPED \] / { if (name() == running) running = "" }
    /\[  FAILED  \] [^ ]+\./ { print "failed: " name() }
    /\[  SKIPPED \] [^ ]+\./ { print "skipped: " name() }
    /^Test time =/ { if (running != "") print "did not end: " running; running = "" }
  ' "$build_dir/Testing/Temporary/LastTest.log" | sort -u >&2
}

# run_ctest ARGUMENT...
run_ctest() {
  local status=0
  ctest --test-dir "$build_dir" --output-on-failure --no-tests=error --timeout "$test_timeout" \
    --parallel "$(nproc)" "$@" || status=$?
  name_tests_of_last_run # on both lavapipes none if all is well, so that ctest's summary stands last
  return "$status"
}

# In a subshell, so that one driver's environment does not reach the next.
run_ctest_on() (
  use_driver "$1"
  # Both can present, and all that a window takes is installed (tests/device_view_test.cpp).
  if [[ $1 == private || $1 == stock ]] && command -v Xvfb >/dev/null && command -v xdotool >/dev/null; then
    export COPPICE_TEST_WINDOW=1
  fi
  shift
  run_ctest "$@"
)

# The longest there, which say of many rays and scenes what shorter tests of the same code say of few.
not_sanitized='Watertight.*:HardRaysAre.*:*JudgeAccepts.*:*ClosestExactOn.*'

# all_end_well PID...: waits for all of them.
all_end_well() {
  local pid failures=0
  for pid; do
    wait "$pid" || ((++failures))
  done
  ((failures == 0))
}

# In a process a core: with the sanitizers a process takes longer to start than most of the tests to run.
host_tests_sanitized() {
  local shards shard pids=()
  shards=$(nproc)
  for ((shard = 0; shard < shards; ++shard)); do
    UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 GTEST_TOTAL_SHARDS=$shards GTEST_SHARD_INDEX=$shard \
      timeout "$test_timeout" "$build_dir/sanitize/host_tests" --gtest_brief=1 \
      --gtest_filter="-$not_sanitized" &
    pids+=($!)
  done
  all_end_well "${pids[@]}"
}

# fuzz_reader NAME CORPUS INPUTS: coverage-guided, from the corpus on. What it finds new stays in the build folder and is
# where the next run begins. By the same seed, as many inputs and the same addresses (libFuzzer's choices depend on them)
# every time, so that a program either passes or fails; 25 seconds are a hang, 5 may be a machine that paused.
fuzz_reader() {
  local name=$1 corpus=$root/tests/fuzz/$2 limit=-runs=$3 folder=$build_dir/sanitize/fuzz/$1 same_addresses=(setarch -R)
  [[ -v COPPICE_FUZZ_SECONDS ]] && limit=-max_total_time=$COPPICE_FUZZ_SECONDS
  "${same_addresses[@]}" true 2>/dev/null || same_addresses=() # some containers forbid it
  mkdir -p "$folder/found"
  "${same_addresses[@]}" "$build_dir/sanitize/${name}_fuzzer" "$limit" -reload=0 -seed="${COPPICE_FUZZ_SEED:-1}" \
    -timeout=25 -rss_limit_mb=2048 -max_len=4096 -dict="$root/tests/fuzz/$name.dict" \
    -artifact_prefix="$folder/" "$folder/found" "$corpus" \
    >"$folder/fuzz.log" 2>&1 </dev/null && return
  tail -n 60 "$folder/fuzz.log" >&2
  say "failed: ${name}_fuzzer (log: $folder/fuzz.log)"
  return 1
}

fuzz_readers() {
  local pids=()
  fuzz_reader obj corpus 8000 &
  pids+=($!)
  fuzz_reader gltf corpus_gltf 4000 &
  pids+=($!)
  fuzz_reader scene_file corpus_scene_file 4000 &
  pids+=($!)
  fuzz_reader ply corpus_ply 4000 &
  pids+=($!)
  all_end_well "${pids[@]}"
}

install_missing "${build_packages[@]}" "${test_packages[@]}"
available_drivers
reference=${drivers[0]}

if (($#)); then
  build ci "$build_dir"
  run_ctest_on "$reference" "$@"
  exit
fi

# The tests of a suite in one process, which takes a fraction of the time (tests/suites.cmake).
export COPPICE_TEST_SUITES=1

check "format" format_is_clean
timed "building everything" build ci "$build_dir"
if command -v clang++ >/dev/null; then
  timed "building everything by clang, host tests and fuzzers with sanitizers" build sanitize "$build_dir/sanitize"
  check "host tests under AddressSanitizer and UndefinedBehaviorSanitizer" host_tests_sanitized
  check "the readers of OBJ, glTF, scene and PLY files under libFuzzer" fuzz_readers
else
  say "no clang: nothing is compiled by it, there are no sanitizers, and no reader is fuzzed"
fi
for driver in "${drivers[@]:1}"; do
  COPPICE_TEST_EXCEPT=$reference_only check "device tests on $(describe_driver "$driver")" \
    run_ctest_on "$driver" -L device -LE reference_only
done

# The table of times comes before ctest's summary, which stands last: ctest says how long it takes by itself.
say_times
say "$("$build_dir/host_tests" --gtest_list_tests | grep -c '^ ') host tests and" \
  "$("$build_dir/device_tests" --gtest_list_tests | grep -c '^ ') device tests, of which ctest counts the suites"
check "all tests on $(describe_driver "$reference")" run_ctest_on "$reference"
