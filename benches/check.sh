#!/bin/sh
# Holds the instructions of a step, of ten modes and of a speed of a Campbell diagram to benches/instructions.txt: fails
# where one is dearer by more than 2 %, or where twice the elements take more than 2.05 times the instructions.
# Counted under valgrind, so free of the noise of other work on the machine, but not of the compiler: with another
# compiler than the one the file names the counts are shown and not judged. `benches/check.sh --accept` writes
# the file anew.
set -eu
cd "$(dirname "$0")/.."
file=benches/instructions.txt
allowed=2 # %
if ! command -v valgrind >/dev/null 2>&1; then
    echo "valgrind is not installed: instructions are not counted"
    exit 0
fi
compiler="$(rustc --version) on $(uname -m)"
counts=$(mktemp)
trap 'rm -f "$counts"' EXIT
benches/count.sh 10 | tail -n +2 >"$counts"
if [ "${1:-}" = --accept ]; then
    {
        echo "# Instructions a step: benches/check.sh compares, benches/check.sh --accept writes."
        echo "# $compiler"
        echo "coupling,integrator,elements,instructions per step"
        cat "$counts"
    } >"$file"
    echo "written: $file"
    exit 0
fi
judged=1
if [ "$(sed -n '2s/^# //p' "$file")" != "$compiler" ]; then
    echo "counted with $compiler; $file with $(sed -n '2s/^# //p' "$file"): not judged"
    judged=0
fi
awk -F, -v allowed="$allowed" -v judged="$judged" '
    FNR == NR { if ($4 ~ /^[0-9]+$/) expected[$1 "," $2 "," $3] = $4; next }
    {
        was = expected[$1 "," $2 "," $3]
        if (!was) { printf "%s %s %d: not in the file; run benches/check.sh --accept\n", $1, $2, $3; bad = 1; next }
        change = 100 * ($4 / was - 1)
        printf "%-11s %-8s %6d elements: %8d instructions a step (%+.1f %%)\n", $1, $2, $3, $4, change
        if (change > allowed) { print "    dearer by more than " allowed " %"; bad = 1 }
        if ($1 == "waves") {
            if (half) printf "    %.3f times those of half the elements\n", $4 / half
            if (half && $4 > 2.05 * half) { print "    more than 2.05 times"; bad = 1 }
            half = $4
        }
        seen++
    }
    END {
        if (!seen) { print "nothing was counted"; exit 1 }
        exit bad && judged
    }' "$file" "$counts"
