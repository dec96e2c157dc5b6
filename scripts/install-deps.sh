#!/bin/bash
# Installs the Debian packages that Nullcone needs (Debian 12). Quiet and quick when they are there.
#   scripts/install-deps.sh          to build and run
#   scripts/install-deps.sh --test   also what scripts/test.sh needs
#   scripts/install-deps.sh --fuzz   also what scripts/fuzz.sh needs
set -eu
cd "$(dirname "$0")/.."
packages=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libboost-dev          # Odeint
  libeigen3-dev         # small linear algebra in post-rendering
  libxsimd-dev          # packs of rays
  libtbb-dev            # threads
  libopenexr-dev libimath-dev   # datasets
  libopenimageio-dev    # textures and pictures
  liblcms2-dev          # ICC profiles in pictures
  libtinyobjloader-dev libtinygltf-dev   # meshes: Wavefront OBJ, glTF
  libmurmurhash-dev     # names in Cryptomatte layers
  libturbojpeg0-dev libwebp-dev libpng-dev   # pictures that the viewer sends
  nlohmann-json3-dev libcli11-dev libssl-dev   # JSON, command lines, SHA-256
  libgtest-dev libbenchmark-dev python3   # tests and benchmarks
  xplanet-images        # the map of the Earth that the demo shows
)
case ${1:-} in
  --test)
    packages+=(clang-format openexr python3-openimageio python3-numpy   # the last reads datasets as users do
               python3-jsonschema   # scenes and looks as editors check them
               chromium nodejs   # the viewer's page in a browser
               slurm-wlm)        # a cluster of two nodes on this machine; brings munge
    command -v npm >/dev/null || packages+=(npm)   # some builds of nodejs bring their own
    ;;
  --fuzz) packages+=(clang libclang-rt-dev) ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
install() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "install-deps: needs root or sudo to install: $*" >&2; exit 1; }
    as_root=(sudo)
  fi
  echo "install-deps: installing $*" >&2
  export DEBIAN_FRONTEND=noninteractive
  "${as_root[@]}" apt-get -qq update
  "${as_root[@]}" apt-get -qq -y --no-install-recommends install "$@" >/dev/null
}
[ ${#missing[@]} -eq 0 ] || install "${missing[@]}"

# What drives the browser in tests; its exact version and SHA-512 stand in package-lock.json.
if [ "${1:-}" = --test ] && [ ! tests/view/node_modules/.package-lock.json -nt tests/view/package-lock.json ]; then
  npm ci --prefix tests/view --loglevel=error
fi
