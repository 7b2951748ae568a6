# shellcheck shell=bash disable=SC2034
# Sourced by run.sh and test.sh: installing what is missing, building, choosing the Vulkan driver.
# Everything it says goes to stderr, so that `run.sh ... --json -` leaves stdout to coppice.

# Two levels up from this file, whatever the caller's working directory.
root=$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")
build_dir=$root/build
lavapipe_dir=$build_dir/lavapipe

build_packages=(
  g++ cmake ninja-build glslang-tools spirv-tools libvulkan-dev libglm-dev libglfw3-dev
  libimgui-dev libtinyobjloader-dev libtinygltf-dev libvalijson-dev libcli11-dev nlohmann-json3-dev libstb-dev
  libtbb-dev libgmp-dev libopenexr-dev mesa-vulkan-drivers xz-utils
)
test_packages=(
  libgtest-dev libgmock-dev libbenchmark-dev vulkan-validationlayers clang-format libembree-dev
  xvfb xdotool clang libclang-rt-dev
)
# Built from the same sources as the lavapipe; without its own libdrm it would meet the system's older one.
lavapipe_packages=(mesa-vulkan-drivers libdrm2 libdrm-amdgpu1)
# Older lavapipes stop every loop after 65,535 turns and are slow with device addresses.
oldest_good_mesa=25

say() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
}

die() {
  say "$@"
  exit 1
}

# --- packages ---------------------------------------------------------------------------------------------

missing_packages() {
  local installed package
  installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null || true)
  for package in "$@"; do
    grep -qxF "$package installed" <<<"$installed" || printf '%s\n' "$package"
  done
}

# install_missing PACKAGE...: silent and without the network when nothing is missing.
install_missing() {
  local missing log
  local -a as_root=()
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    say "not a Debian system: going on with what is installed (Debian's names: $*)"
    return
  fi
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "please install as root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  mkdir -p "$build_dir"
  log=$build_dir/install.log
  say "installing ${#missing[@]} packages: ${missing[*]}"
  local -a apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  # A source that cannot be reached matters only if a package is then missing, so update may fail.
  "${apt[@]}" update >"$log" 2>&1 || true
  if ! "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >>"$log" 2>&1 </dev/null; then
    tail -n 5 "$log" >&2
    die "could not install ${missing[*]} (log: $log)"
  fi
}

# --- building ---------------------------------------------------------------------------------------------

# show_progress [WORDS]: Ninja's counter on one line of a terminal; nothing in a pipe. WORDS are said at the first step
# that builds something, and not where Ninja only looks for changes (which `ninja -n` cannot tell: files found by pattern
# count as changed there).
show_progress() {
  local line words=${1-}
  while IFS= read -r line; do
    [[ $line =~ ^(\[[0-9]+/[0-9]+\])' '(.*) && ${BASH_REMATCH[2]} != Re-* ]] || continue
    [[ -z $words ]] || say "$words"
    words=
    [[ ! -t 2 ]] || printf '\r%s ' "${BASH_REMATCH[1]}" >&2
  done
  [[ ! -t 2 ]] || printf '\r\e[K' >&2
}

# logged LOG WORDS COMMAND...: appends to LOG, and shows its end only if the command fails. WORDS as for show_progress.
logged() {
  local log=$1 words=$2
  shift 2
  if ! "$@" </dev/null 2>&1 | tee -a "$log" | show_progress "$words"; then
    tail -n 60 "$log" >&2
    die "failed: $* (log: $log)"
  fi
}

# build PRESET FOLDER [TARGET...]: configures if needed and builds all targets, or the ones named.
build() {
  local preset=$1 folder=$2 log=$2/build.log
  shift 2
  mkdir -p "$folder"
  (
    cd "$root" || exit
    flock 9 # two scripts at once in one build folder would break each other's files
    : >"$log"
    if ! configured "$preset" "$folder"; then
      say "configuring ($preset)"
      logged "$log" "" cmake --preset "$preset"
      touch "$folder/configured-$preset"
    fi
    logged "$log" "building ($preset); the first time takes minutes" \
      cmake --build "$folder" --parallel "$(nproc)" ${1+--target "$@"}
  ) 9>"$folder/.lock"
}

# Ninja reconfigures by itself when a CMakeLists.txt changes. Left to us: another preset's cache variables,
# and packages that came after the last configuration. A ci configuration serves for a release build too.
configured() {
  local preset=$1 folder=$2 stamp=$2/configured-$1
  [[ -f $folder/build.ninja ]] || return 1
  [[ $preset == release && ! -f $stamp ]] && stamp=$folder/configured-ci
  [[ -f $stamp && ! $root/CMakePresets.json -nt $stamp && ! /var/lib/dpkg/status -nt $stamp ]]
}

# --- the Vulkan driver ------------------------------------------------------------------------------------

# has_icd NAME...: a system driver whose manifest's name starts so.
has_icd() {
  local name
  for name in "$@"; do
    compgen -G "/usr/share/vulkan/icd.d/$name*.json" >/dev/null && return
    compgen -G "/etc/vulkan/icd.d/$name*.json" >/dev/null && return
  done
  return 1
}

# A GPU that Vulkan can reach: a device node that may be opened, and the driver that goes with it. Looking
# under /dev and not only under /sys keeps containers, which see the host's /sys, from finding a GPU they
# cannot use. In doubt the answer is no, and COPPICE_DRIVER=system overrules it.
has_gpu() {
  local node
  if compgen -G '/dev/nvidia[0-9]*' >/dev/null && has_icd nvidia; then
    return
  fi
  for node in /dev/dri/renderD*; do
    [[ -r $node && -w $node ]] || continue
    case $(basename "$(readlink -f "/sys/class/drm/${node##*/}/device/driver")") in
      amdgpu) has_icd radeon amd && return ;;
      i915 | xe) has_icd intel && return ;;
      nvidia*) has_icd nvidia && return ;;
      nouveau) has_icd nouveau && return ;;
      v3d | vc4) has_icd broadcom && return ;;
      msm*) has_icd freedreno && return ;;
    esac
  done
  return 1
}

stock_manifest() {
  compgen -G '/usr/share/vulkan/icd.d/lvp_icd*.json' | head -n 1
}

stock_mesa_version() {
  dpkg-query -W -f '${Version}\n' mesa-vulkan-drivers 2>/dev/null | head -n 1
}

stock_mesa_is_good() {
  [[ -n $(stock_manifest) ]] && dpkg --compare-versions "$(stock_mesa_version)" ge "$oldest_good_mesa"
}

# The archives this machine's apt takes Debian from, most promising first: where apt knows what an archive
# calls itself, that decides; where its lists were deleted, the suite's name in the sources. An archive that
# is not Debian's fails the signature check later.
# shellcheck disable=SC2016 # apt-get fills in $(NAME), not the shell
debian_archives() {
  local codename=$1
  {
    apt-get indextargets --format '$(REPO_URI)' 'Origin: Debian Backports' "Codename: $codename-backports"
    apt-get indextargets --format '$(REPO_URI)' 'Origin: Debian' "Codename: $codename"
    apt-get --no-release-info indextargets --format '$(RELEASE) $(REPO_URI)' |
      awk -v codename="$codename" '$1 == codename || $1 ~ /^(old)?stable$/ { print $2 }'
  } 2>/dev/null | awk '!seen[$0]++'
}

# download_lavapipe FOLDER ARCHIVE CODENAME: asks apt with a state of its own, which leaves the system's
# sources, lists and packages alone but keeps its proxy settings, and needs no root.
download_lavapipe() {
  local folder=$1 archive=$2 codename=$3
  local -a apt=(
    timeout 180 apt-get -q -o "Dir::State=$folder/state" -o Dir::State::status=/dev/null
    -o "Dir::Cache=$folder/cache" -o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o Dir::Etc::Preferences=/dev/null -o Dir::Etc::PreferencesParts=/dev/null
    -o APT::Sandbox::User=root -o Acquire::Languages=none -o Acquire::http::Timeout=20 -o Acquire::Retries=1
  )
  mkdir -p "$folder"/{state/lists/partial,cache/archives/partial,debs} &&
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $archive $codename-backports main" \
      >"$folder/sources.list" &&
    "${apt[@]}" update &&
    (cd "$folder/debs" && "${apt[@]}" download "${lavapipe_packages[@]}")
}

# assemble_lavapipe FOLDER: FOLDER/debs becomes FOLDER/ready with lvp_icd.json, lib/ and the version. Only
# lavapipe and its libdrm are kept. The manifest names its library relative to itself: the folder may move.
assemble_lavapipe() {
  local folder=$1 ready=$1/ready deb manifest library
  for deb in "$folder"/debs/*.deb; do
    dpkg-deb -x "$deb" "$folder/unpacked" || return
  done
  manifest=$(compgen -G "$folder/unpacked/usr/share/vulkan/icd.d/lvp_icd*.json" | head -n 1) &&
    library=$(compgen -G "$folder/unpacked/usr/lib/*/libvulkan_lvp.so" | head -n 1) &&
    mkdir -p "$ready/lib" &&
    cp -a "$library" "${library%/*}"/libdrm* "$ready/lib/" &&
    sed -E 's#("library_path": *)"[^"]*"#\1"./lib/libvulkan_lvp.so"#' "$manifest" >"$ready/lvp_icd.json" &&
    dpkg-deb -f "$folder"/debs/mesa-vulkan-drivers_*.deb Version >"$ready/version" || return
  # What the library needs beyond that comes with the system's own mesa-vulkan-drivers.
  if LD_LIBRARY_PATH=$ready/lib ldd "$ready/lib/libvulkan_lvp.so" | grep 'not found'; then
    return 1
  fi
}

# Unpacks beside the final place and renames, so that an interrupted run leaves no half driver.
fetch_lavapipe() (
  codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
  [[ -n $codename ]] && command -v apt-get >/dev/null || exit 1
  mkdir -p "$build_dir" && folder=$(mktemp -d "$build_dir/lavapipe.XXXXXX") || exit 1
  trap 'rm -rf "$folder"' EXIT
  while read -r archive; do
    rm -rf "${folder:?}"/*
    if download_lavapipe "$folder" "$archive" "$codename" && assemble_lavapipe "$folder"; then
      # Fails when another run was faster; then its driver serves.
      mv -T "$folder/ready" "$lavapipe_dir" || [[ -f $lavapipe_dir/lvp_icd.json ]]
      exit
    fi
  done < <(debian_archives "$codename")
  echo "no archive of this machine's apt has a usable lavapipe in $codename-backports"
  exit 1
)

# Makes build/lavapipe exist. Once unpacked it serves without the network. A failure is remembered for a
# day, so that a machine without a network does not wait for it at every run.
have_private_lavapipe() {
  local failed=$build_dir/lavapipe-failed log=$build_dir/lavapipe.log
  [[ -f $lavapipe_dir/lvp_icd.json ]] && return
  [[ -n $(find "$failed" -mmin -1440 2>/dev/null) ]] && return 1
  mkdir -p "$build_dir"
  say "fetching a newer lavapipe into build/lavapipe"
  if fetch_lavapipe >"$log" 2>&1 </dev/null; then
    rm -f "$failed"
    return
  fi
  touch "$failed"
  return 1
}

# available_drivers: sets `drivers` to the ways this machine can run, the reference first:
#   given    VK_DRIVER_FILES (or its older name) as the user has set it
#   private  the newer lavapipe under build/
#   stock    the system's lavapipe
#   system   whatever the Vulkan loader finds, which means a GPU
# COPPICE_DRIVER = auto | private | stock | system narrows them.
available_drivers() {
  drivers=()
  if [[ -n ${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-} ]]; then
    drivers=(given)
    return
  fi
  case ${COPPICE_DRIVER:-auto} in
    private)
      rm -f "$build_dir/lavapipe-failed" # asked for by name: worth another try
      have_private_lavapipe || die "no private lavapipe to be had (log: $build_dir/lavapipe.log)"
      drivers=(private)
      ;;
    stock)
      [[ -n $(stock_manifest) ]] || die "the system has no lavapipe (package mesa-vulkan-drivers)"
      drivers=(stock)
      ;;
    system) drivers=(system) ;;
    auto) automatic_drivers "${1:-all}" ;;
    *) die "COPPICE_DRIVER is '$COPPICE_DRIVER', not auto, private, stock or system" ;;
  esac
}

# With "first" stops at the one to run on; with "all" finds every one to test on.
automatic_drivers() {
  if [[ $1 == first ]] && has_gpu; then
    drivers=(system)
    return
  fi
  if ! stock_mesa_is_good && command -v apt-get >/dev/null; then
    if have_private_lavapipe; then
      drivers+=(private)
    else
      say "no newer lavapipe to be had (log: $build_dir/lavapipe.log): going on with Mesa $(stock_mesa_version)"
    fi
  fi
  [[ -z $(stock_manifest) ]] || drivers+=(stock)
  if ((${#drivers[@]} == 0)) || has_gpu; then
    drivers+=(system)
  fi
}

# use_driver NAME: points this process and its children at it.
use_driver() {
  case $1 in
    private)
      export VK_DRIVER_FILES=$lavapipe_dir/lvp_icd.json
      export LD_LIBRARY_PATH=$lavapipe_dir/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
      ;;
    stock) VK_DRIVER_FILES=$(stock_manifest) && export VK_DRIVER_FILES ;;
  esac
}

describe_driver() {
  case $1 in
    private) echo "lavapipe, Mesa $(cat "$lavapipe_dir/version")" ;;
    stock) echo "lavapipe, Mesa $(stock_mesa_version)" ;;
    given) echo "driver ${VK_DRIVER_FILES:-$VK_ICD_FILENAMES}" ;;
    system) echo "the system's driver" ;;
  esac
}

# For run.sh: the one driver to run on.
setup_driver() {
  available_drivers first
  use_driver "${drivers[0]}"
}
