#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds in release and runs coppice:
#   ./run.sh                     renders the built-in scene to build/grove.png
#   ./run.sh my.obj [OPTION...]  renders that file (or a built-in scene by name) to build/my.png
#   ./run.sh COMMAND ...         any other command line of coppice; `./run.sh --help` lists them
# COPPICE_DRIVER=auto|private|stock|system chooses the Vulkan driver, see host/setup.sh.
set -euo pipefail
source "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/host/setup.sh"

names_output() {
  local argument
  for argument in "$@"; do
    case $argument in
      -o* | --output | --output=*) return 0 ;;
    esac
  done
  return 1
}

# Shorter to read where the user stands in the checkout; right wherever they stand.
picture_path() {
  if [[ $PWD -ef $root ]]; then
    echo "build/$1.png"
  else
    echo "$build_dir/$1.png"
  fi
}

install_missing "${build_packages[@]}"
build release "$build_dir" coppice coppice_installed # the library too, for cmake --install
setup_driver

coppice=$build_dir/coppice
case ${1-} in
  '')
    (($# == 0)) || die "the first argument is empty; a scene or a command belongs there"
    exec "$coppice" render -o "$(picture_path grove)"
    ;;
  -* | render | build | compare | lockstep | accuracy | animate | view | scenes | devices | bench | tune | stability)
    exec "$coppice" "$@"
    ;;
esac

stem=$(basename -- "$1")
stem=${stem%.*}
if names_output "$@"; then
  exec "$coppice" render "$@"
fi
exec "$coppice" render "$@" -o "$(picture_path "${stem:-scene}")"
