#!/usr/bin/env bash
# Whole runs against commit 362d602, which is built from git: processor time as a ratio (the least of several runs), and the
# instructions of the integration, without files and pictures, beside it.
#
#   benches/whole.sh            all runs
#   benches/whole.sh exact      those whose name contains `exact`
#
# The old program is built once, in target/362d602. Where valgrind is installed the instructions are counted too; the ratios
# of times are those of this machine, the instructions those of the compiler.
set -euo pipefail
cd "$(dirname "$0")/.."
commit=362d602
old_tree=target/$commit
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
if [ ! -x "$old_tree/target/release/flexion" ]; then
    mkdir -p "$old_tree"
    git archive "$commit" | tar -x -C "$old_tree"
    # Without the clock of the kernel's page, which valgrind does not show.
    (cd "$old_tree" && RUSTFLAGS="--cfg rustix_use_libc" CARGO_TARGET_DIR="$PWD/target" cargo build --release -p flexion-cli)
fi
cargo build --release -p flexion-cli
old=$old_tree/target/release/flexion
new=target/release/flexion

# Name, case and changes that both versions understand.
runs=(
    "first-radau|p1_spin_up_4|model.coupling=first"
    "exact-radau|p1_spin_up_4|model.coupling=exact"
    "high-radau|p1_spin_up_4|model.coupling=high"
    "exact-radau-1e-8|p1_spin_up_4|model.coupling=exact integrator={kind='radau',tolerance=1e-8,absolute-tolerance=1e-10}"
    "first-newmark|p1_spin_up_4|model.coupling=first integrator={kind='newmark',step='1ms'}"
    "exact-newmark|p1_spin_up_4|model.coupling=exact integrator={kind='newmark',step='1ms'}"
    "pendulum-radau|pendulum_45|model.coupling=exact"
)

# Least processor time of three runs, as they measure it: without reading, files and pictures [s].
seconds() {
    for _ in 1 2 3; do
        "$@" -o "$results/run" --force >/dev/null 2>&1
        sed -n 's/.*"cpu_time": *\([0-9.e-]*\).*/\1/p' "$results/run/summary.json"
    done | sort -g | awk 'NR == 1'
}

# Instructions in and below the driver of a run; nothing without valgrind.
instructions() {
    command -v valgrind >/dev/null 2>&1 || return 0
    valgrind --tool=callgrind --callgrind-out-file="$results/callgrind" "$@" -o "$results/run" --force >/dev/null 2>&1
    callgrind_annotate --inclusive=yes --threshold=100 "$results/callgrind" 2>/dev/null |
        awk '/transient::(transient|transient_to_checkpoint|resume)( |\x27| \[|$)/ && !seen++ { gsub(",", "", $1); print $1 }'
}

echo "run,seconds at $commit,seconds,ratio,instructions at $commit,instructions,ratio"
for run in "${runs[@]}"; do
    IFS='|' read -r name case changes <<<"$run"
    case $name in *"${1:-}"*) ;; *) continue ;; esac
    sets=()
    for change in $changes; do sets+=(--set "$change"); done
    before=("$old" run "$old_tree/verification/$case" "${sets[@]}")
    after=("$new" run "verification/$case" "${sets[@]}" --no-plots --error off)
    times="$(seconds "${before[@]}") $(seconds "${after[@]}")"
    counts="$(instructions "${before[@]}") $(instructions "${after[@]}")"
    echo "$name $times $counts" | awk '{
        printf "%s,%.3f,%.3f,%.2f", $1, $2, $3, $3 / $2
        if (NF == 5) printf ",%d,%d,%.3f", $4, $5, $5 / $4
        print ""
    }'
done
