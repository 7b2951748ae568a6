#!/bin/bash
# Takes the measurements of docs/performance.md anew: CSV files, and plots of them where python3 has matplotlib.
#
#     docs/measurements/measure.sh PREFIX [MOST] [COMMAND...]
#
# writes PREFIX-*.csv and PREFIX-*.svg. MOST is the largest number of triangles (default 10000000); scans and sorts go to
# 16777216 words, or MOST where that is less. COMMAND... runs each measurement, for machines where something must be held
# off meanwhile. COPPICE is the program (default build/coppice). SCENES are the scenes of the trace, between semicolons,
# each with its options: "grove;sponza.obj --camera -120,10,-4,80,35,-4,75" (default grove).
set -euo pipefail
prefix=$1
most=${2:-10000000}
shift $(($# < 2 ? $# : 2))
coppice=${COPPICE:-build/coppice}
words=$((most < 16777216 && most < 10000000 ? most : 16777216))

"$@" "$coppice" bench scan --runs 7 --most $words --csv "$prefix-scan.csv"
for kind in pairs_32 keys_32 pairs_64 keys_64; do
  "$@" "$coppice" bench sort --runs 3 --most $words --only $kind --csv "$prefix-sort_$kind.csv"
done
"$@" "$coppice" bench ploc --radius 8 --runs 25 --most $((most < 1000000 ? most : 1000000)) --csv "$prefix-ploc.csv"
for builder in gpu-ploc gpu-hploc gpu-lbvh; do
  "$@" "$coppice" bench build --radius 8 --runs 3 --most $most --builder $builder --csv "$prefix-$builder.csv"
done
IFS=';' read -ra scenes <<<"${SCENES:-grove}"
for scene in "${scenes[@]}"; do
  read -ra words <<<"$scene"
  "$@" "$coppice" bench trace "${words[@]}" --radius 8 --runs 7 --builder gpu-ploc,gpu-hploc \
    --csv "$prefix-trace_$(basename "${words[0]%.*}").csv"
done
python=${PYTHON:-python3}
if "$python" -c 'import matplotlib' 2>/dev/null; then
  "$python" "$(dirname "$0")/plot.py" "$prefix" "$prefix"-{scan,sort_*,gpu-*}.csv
fi
