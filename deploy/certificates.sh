#!/bin/sh
# certificates.sh FOLDER: an authority, and one certificate for all machines of a cluster: ca.pem, cert.pem and key.pem.
# Whoever has key.pem can run code on every worker. The authority's own key is not kept: a new machine needs no new one.
set -eu
umask 077
mkdir -p "$1"
cd "$1"
for name in ca.pem cert.pem key.pem; do
    if [ -e "$name" ]; then echo "$1/$name is there already" >&2; exit 1; fi
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{
    openssl req -x509 -newkey rsa:3072 -nodes -days 3650 -subj "/CN=wsrender authority" -keyout "$work/ca-key.pem" -out ca.pem
    openssl req -newkey rsa:3072 -nodes -subj "/CN=wsrender" -keyout key.pem -out "$work/request.pem"
    openssl x509 -req -in "$work/request.pem" -CA ca.pem -CAkey "$work/ca-key.pem" -CAcreateserial \
        -CAserial "$work/serial" -days 3650 -out cert.pem
} 2> "$work/log" || { cat "$work/log" >&2; exit 1; }
