# Short names for the commands of this project. `just` lists them.

_default:
    @just --list

# Run a case: `just run verification/p1_spin_up_4`
run case="verification/p1_spin_up_4" *options="":
    cargo run --release -- run {{ case }} --output results/{{ file_stem(case) }} --force {{ options }}

# Run all tests, or those whose name contains a word
test *filter="":
    cargo test --release --workspace {{ filter }}

# The tests to run after every change: half a minute of one processor
quick:
    cargo test --release -p flexion --lib
    cargo test --release -p flexion-case --test integration -- kinds docs broken_cases case_files short_features first_look pendulum spring supports

# Check formatting and lints
lint:
    cargo fmt --all -- --check
    cargo clippy --release --workspace --all-targets -- -D warnings

# Build the documentation of the library, and the book where mdbook is installed
docs:
    cargo doc --no-deps --workspace
    command -v mdbook >/dev/null && cd docs/book && npm ci && npm run build || echo "mdbook is not installed: read docs/src as it is"

# Compare speed and accuracy with Exudyn (needs Python)
bench *options="":
    cargo build --release
    python3 benches/exudyn/compare.py --flexion target/release/flexion {{ options }}

# Everything that is checked before a change is merged
ci:
    .ci/run
