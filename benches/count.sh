#!/bin/sh
# Instructions per step, by the difference of two runs under valgrind: free of the noise of other work on the
# machine, and without set-up, so that all processors count at once. Needs valgrind; `benches/count.sh [elements ...]`.
set -eu
cd "$(dirname "$0")/.."
# --one BINARY COUPLING INTEGRATOR ELEMENTS STEPS: a line of the table.
if [ "${1:-}" = --one ]; then
    instructions() {
        valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 | sed -n 's/.*Collected : //p'
    }
    once=$(instructions "$2" "$3" "$4" "$5" "$6")
    twice=$(instructions "$2" "$3" "$4" "$5" $((2 * $6)))
    echo "$3,$4,$5,$(((twice - once) / $6))"
    exit 0
fi
# With the features that the tests of the workspace are built with: nothing is compiled twice.
binary=$(cargo bench --workspace --bench count --no-run 2>&1 | sed -n 's/.*(\(.*\/count-[0-9a-f]*\)).*/\1/p')
jobs() {
    for elements in "${@:-10}"; do
        for what in "solver none" "first newmark" "exact newmark" "first radau" "exact radau" \
            "first-free newmark" "exact-free newmark" "first-free radau" "exact-free radau" \
            "space alpha" "space radau"; do
            echo "$what $elements 100"
        done
    done
    # Ten modes of forty elements at one speed, and a speed of their Campbell diagram.
    for what in "first modes" "exact modes" "first campbell" "exact campbell"; do
        echo "$what 40 100"
    done
    # A beam of many elements in space, doubled: over enough steps for as many new tangents whenever they come.
    for elements in 1000 2000; do
        echo "waves alpha $elements 40"
    done
}
counted=$(mktemp)
trap 'rm -f "$counted"' EXIT
jobs "$@" | xargs -P "$(getconf _NPROCESSORS_ONLN)" -L 1 benches/count.sh --one "$binary" >"$counted"
echo "coupling,integrator,elements,instructions per step"
jobs "$@" | while read -r coupling integrator elements _; do
    grep "^$coupling,$integrator,$elements," "$counted"
done
