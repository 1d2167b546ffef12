#!/bin/sh
# install_dependencies.sh GROUP...   installs the Debian packages of the groups that are not installed yet.
#   build  what the library and the program need        bench  Google Benchmark and the solvers compared with
#   test   GoogleTest, Boost headers (Multiprecision), the Python of the checks, strace, valgrind
#   lint   clang-format and Python
#   asan   clang with its sanitizers                    tsan   asan, and what rebuilding TBB from source needs
#   browser  a browser without a screen, for the pages of reports
#   vtk    VTK for Python, which reads what was written for it
#   manual mkdocs, which renders the manual             deb    dpkg-shlibdeps, which finds what a package needs
#   all    everything, with coverage and clang-tidy for `make check-all`
# dpkg is asked first: when nothing is missing, neither the network nor root is needed. With --list the packages are
# printed and nothing is done.
set -eu

packages_of() {
  case "$1" in
    build)
      echo g++ cmake ninja-build libeigen3-dev libtbb-dev nlohmann-json3-dev libcli11-dev \
        libsuitesparse-dev libmetis-dev zlib1g-dev ;;
    test) echo libgtest-dev libgmock-dev libboost-dev libmuparser-dev python3 python3-jsonschema python3-numpy strace valgrind ;;
    bench)
      echo libbenchmark-dev python3 libsuitesparse-dev libmumps-seq-dev libsuperlu-dev libopenblas-pthread-dev ;;
    lint) echo clang-format-14 python3 ;;
    asan) echo clang-14 lld-14 libclang-rt-14-dev llvm-14 ;;
    tsan) echo clang-14 lld-14 libclang-rt-14-dev llvm-14 dpkg-dev util-linux ;;
    browser) echo chromium python3 ;;
    vtk) echo python3-vtk9 python3-numpy ;;
    manual) echo mkdocs ;;
    deb) echo dpkg-dev file fakeroot ;;
    all)
      for group in build test bench lint asan tsan browser vtk manual deb; do packages_of $group; done
      echo ccache gcovr clang-tidy-14 ;;
    *)
      echo "install_dependencies.sh: no group '$1'" >&2
      return 1 ;;
  esac
}

list_only=no
if [ "${1:-}" = --list ]; then
  list_only=yes
  shift
fi
wanted=
for group in "${@:-build}"; do
  wanted="$wanted $(packages_of "$group")"
done
wanted=$(printf '%s\n' $wanted | sort -u)
if [ "$list_only" = yes ]; then
  echo "$wanted"
  exit 0
fi

if ! command -v dpkg-query >/dev/null; then
  echo "This system has no dpkg. Please see to it that the equivalents of these Debian packages are installed:"
  echo $wanted
  exit 0
fi

missing=
for package in $wanted; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  case "$status" in
    installed*) ;;
    *) missing="$missing $package" ;;
  esac
done
if [ -z "$missing" ]; then
  exit 0
fi

as_root=
if [ "$(id -u)" -ne 0 ]; then
  as_root=sudo
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing and this user is not root; please install them:$missing" >&2
    exit 1
  fi
fi
echo "Installing with apt-get${as_root:+ under sudo}:$missing"
[ -z "$as_root" ] || echo "To install them in another way: interrupt this, and then run make with NEED=true."
export DEBIAN_FRONTEND=noninteractive
# Another program may be at apt or dpkg, as unattended upgrades are at night: its end is waited for. apt-get waits by itself
# for the locks of dpkg, but not for those of the lists of packages and of the archives.
patience=1800
apt_once() {
  $as_root env LC_ALL=C DEBIAN_FRONTEND=noninteractive apt-get -qq -o Acquire::Retries=3 -o Dpkg::Use-Pty=0 \
    -o DPkg::Lock::Timeout="$patience" "$@" 2>&1
}
apt() {
  waited=0
  until told=$(apt_once "$@"); do
    case "$told" in
      *"Could not get lock"* | *"Unable to lock "*) ;;
      *) waited=$patience ;;
    esac
    if [ "$waited" -ge "$patience" ]; then
      echo "$told" >&2
      return 1
    fi
    [ "$waited" -gt 0 ] || echo "Waiting for another program to let go of apt"
    sleep 5
    waited=$((waited + 5))
  done
}
apt update
apt install -y --no-install-recommends $missing
echo "Installed."
