#!/bin/sh
# check_apt_lock.sh INSTALL SCRATCH   install_dependencies.sh waits for others who are at apt, and fails at once where that is not why.
# apt-get and dpkg-query are stand-ins, which write down how they are called.
set -eu
install=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch/bin"
cd "$scratch"
cat > bin/dpkg-query <<'END'
#!/bin/sh
echo not-installed
END
cat > bin/apt-get <<'END'
#!/bin/sh
echo "$*" >> calls
case "$*" in
  *" update"*)
    if [ -e broken ]; then echo "E: The repository is not signed." >&2; exit 100; fi
    if [ ! -e was_held ]; then
      touch was_held
      echo "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (apt-get)" >&2
      exit 100
    fi ;;
esac
END
printf '#!/bin/sh\nwhile [ "${1#*=}" != "$1" ]; do shift; done\nexec "$@"\n' > bin/sudo
chmod +x bin/*
PATH=$scratch/bin:$PATH sh "$install" lint > told 2>&1 || { cat told; echo "gave up"; exit 1; }
test "$(grep -c ' update' calls)" = 2 || { cat calls; echo "did not try again"; exit 1; }
grep -q 'DPkg::Lock::Timeout=[1-9].* install .*clang-format-14' calls || { cat calls; echo "does not wait for dpkg"; exit 1; }
touch broken
rm calls
if PATH=$scratch/bin:$PATH sh "$install" lint > told 2>&1; then echo "took a failure for success"; exit 1; fi
grep -q 'not signed' told || { cat told; echo "does not tell why"; exit 1; }
test "$(grep -c ' update' calls)" = 1 || { cat calls; echo "tried again in vain"; exit 1; }
