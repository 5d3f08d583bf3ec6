#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages named as arguments, as far as they are missing.
# Asks dpkg first, so that a machine that has them all is not touched (no network, no root needed).
set -eu

say() { printf '%s\n' "$*" >&2; }

if ! command -v dpkg-query >/dev/null 2>&1; then
  say "install-packages: no dpkg here; going on in the hope that these are installed: $*"
  exit 0
fi

# Prints those of the packages "$@" that are not installed.
list_missing() {
  for package in "$@"; do
    status=$(dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | head -n 1) || true
    [ "$status" = installed ] || printf ' %s' "$package"
  done
}

missing=$(list_missing "$@")
[ -n "$missing" ] || exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=
elif command -v sudo >/dev/null 2>&1 && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
  as_root=sudo
else
  say "install-packages: these packages are missing:$missing"
  say "install-packages: installing needs root or sudo; as an administrator, run:"
  say "    apt-get update && apt-get install --no-install-recommends$missing"
  exit 1
fi

# Another run of the package manager (unattended upgrades, say) is waited for: apt-get waits for the
# lock of dpkg by itself, but not for that of the lists.
apt() {
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600 "$@"
}
update() {
  for wait in 5 10 20 40 80 160; do
    message=$(apt update 2>&1) && return 0
    case $message in
      *"Could not get lock"*) say "install-packages: waiting for another apt-get" ;;
      *) break ;;
    esac
    sleep $wait
  done
  say "$message"
  return 1
}

say "install-packages: installing$missing"
# The package list is split into words on purpose. Output goes to standard error, so that a caller's
# standard output stays its own.
# shellcheck disable=SC2086
{
  update && apt install -y --no-install-recommends -o Dpkg::Use-Pty=0 $missing
} >&2 || {
  say "install-packages: apt-get failed; the packages needed are:$missing"
  exit 1
}
