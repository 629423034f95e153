#!/bin/sh
# check.sh [FOLDER]: whether systemd understands the units of a folder (this one), and how exposed it finds them.
# It needs no running systemd: they are installed into a file tree of their own, with stubs for the programs.
set -eu
here=$(realpath "${1:-$(dirname "$0")}")
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
"$here/install.sh" "$root"
mkdir -p "$root/opt/wsrender/bin"
for program in dask wsrender; do
    printf '#!/bin/sh\n' > "$root/opt/wsrender/bin/$program"
    chmod +x "$root/opt/wsrender/bin/$program"
done
for unit in wsrender wsrender-scheduler wsrender-worker; do
    systemd-analyze verify --root="$root" --man=no --recursive-errors=no "/etc/systemd/system/$unit.service"
    # A threshold of 25 is an exposure of 2.5, of 10.
    systemd-analyze security --offline=true --root="$root" --threshold=25 --no-pager "$unit.service" > "$root/security" ||
        { cat "$root/security"; exit 1; }
    tail -n 1 "$root/security"
done
