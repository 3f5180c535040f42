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

# build_viewer [--test]: makes viewer/dist/viewer.html, the page without a run, where sources are newer than it. Udar works
# without it, so what fails here is said and passed over, but for --test, which also installs what tests need.
build_viewer() {
  local viewer=$root/viewer only=(--omit=dev) failure=0
  local installed=$viewer/node_modules/.package-lock.json page=$viewer/dist/viewer.html
  if [[ ${1:-} == --test ]]; then failure=1; fi
  if ! command -v npm >/dev/null; then
    echo "there is no npm: runs will have no report.html (Debian: apt install nodejs npm, then this script again)"
    return "$failure"
  fi
  # What tests need is not taken away again.
  if [[ ${1:-} == --test || -d $viewer/node_modules/playwright-core ]]; then only=(); fi
  if [[ ! -e $installed || $viewer/package-lock.json -nt $installed ||
    (${#only[@]} -eq 0 && ! -d $viewer/node_modules/playwright-core) ]]; then
    quietly "installing the viewer's libraries" npm --prefix "$viewer" ci --ignore-scripts "${only[@]}" || return "$failure"
  fi
  if [[ ! -e $page || -n $(find "$viewer/src" "$viewer/build.mjs" "$installed" -newer "$page" -print -quit) ]]; then
    quietly "building the viewer" npm --prefix "$viewer" run build || return "$failure"
  fi
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
