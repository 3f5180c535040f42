# shellcheck shell=bash
# Shared by the scripts beside it; sourced, not run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# quietly WHAT COMMAND...: says what is being done; shows the command's output only where it fails.
quietly() {
  local what=$1 begin=$SECONDS status=0
  shift
  local log
  log=$(mktemp)
  printf '%s ... ' "$what"
  "$@" >"$log" 2>&1 </dev/null || status=$?
  if ((status == 0)); then
    echo "done ($((SECONDS - begin)) s)"
  else
    echo "failed"
    grep -vE '^(\[[0-9]+/[0-9]+\]|-- )' "$log" | tail -n 200 || true
  fi
  rm -f "$log"
  return "$status"
}

# build PRESET [TARGET...]: brings build/PRESET up to date.
build() { quietly "building ($1)" build_now "$@"; }

build_now() {
  local preset=$1 launcher=() targets=()
  shift
  if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  if (($# > 0)); then targets=(--target "$@"); fi
  cmake -S "$root" --preset "$preset" "${launcher[@]}" &&
    cmake --build "$root/build/$preset" --parallel "$(nproc)" "${targets[@]}"
}
