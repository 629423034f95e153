#!/bin/sh
# install.sh [ROOT]: the user wsrender, the folder of settings and the units, on this machine or in a file tree at ROOT.
set -eu
here=$(dirname "$(realpath "$0")")
root=${1:-}
install -d -m 750 "$root/etc/wsrender"
if [ -z "$root" ]; then
    id wsrender > /dev/null 2>&1 || useradd --system --user-group --home-dir /var/lib/wsrender --shell /usr/sbin/nologin wsrender
    chgrp wsrender /etc/wsrender
fi
for unit in wsrender wsrender-scheduler wsrender-worker; do
    install -D -m 644 "$here/$unit.service" "$root/etc/systemd/system/$unit.service"
    install -D -m 644 "$here/hardening.conf" "$root/etc/systemd/system/$unit.service.d/hardening.conf"
done
