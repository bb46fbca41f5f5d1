#!/bin/sh
# Instructions per step, by the difference of two runs under valgrind: free of the noise of other work on the
# machine, and without set-up. Needs valgrind; `benches/count.sh [elements ...]`.
set -eu
cd "$(dirname "$0")/.."
binary=$(cargo bench --bench count --no-run 2>&1 | sed -n 's/.*(\(.*\/count-[0-9a-f]*\)).*/\1/p')
instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$binary" "$@" 2>&1 |
        sed -n 's/.*Collected : //p'
}
# COUPLING INTEGRATOR ELEMENTS STEPS
count() {
    once=$(instructions "$1" "$2" "$3" "$4")
    twice=$(instructions "$1" "$2" "$3" $((2 * $4)))
    echo "$1,$2,$3,$(((twice - once) / $4))"
}
echo "coupling,integrator,elements,instructions per step"
for elements in "${@:-10}"; do
    for what in "solver none" "first newmark" "exact newmark" "first radau" "exact radau" \
        "first-free newmark" "exact-free newmark" "first-free radau" "exact-free radau" \
        "space alpha" "space radau"; do
        count $what "$elements" 100
    done
done
# Ten modes of forty elements at one speed, and a speed of their Campbell diagram.
for what in "first modes" "exact modes" "first campbell" "exact campbell"; do
    count $what 40 100
done
# A beam of many elements in space, doubled: over enough steps for as many new tangents whenever they come.
for elements in 1000 2000; do
    count waves alpha "$elements" 40
done
