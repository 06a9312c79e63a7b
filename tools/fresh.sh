#!/bin/sh
# Runs the two commands of the README like a new user: in a clean clone of this tree, on a minimal Debian or Ubuntu
# system. The system has this machine's release. debootstrap makes it from this machine's mirror, and it is deleted at
# the end. debootstrap is installed if missing, which does not affect the minimal system. If such a system cannot be
# made (no root, no apt, no mirror), one line says so, and the commands run in a clean clone on this machine.
# Usage: tools/fresh.sh
set -eu
cd "$(dirname "$0")/.."
tree=$PWD
work=$(mktemp -d)
root=$work/root
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 1' INT TERM
commands=$(sed -n '/^## Set up/,/^## [^S]/s/^    \(tools\/[a-z-]*\.sh\).*/\1/p' README.md | head -n 2)

# URI, release and section of each package list of this machine that belongs to the distribution.
sources() {
    # shellcheck disable=SC1091,SC2154,SC2016 # os-release sets them; apt fills in
    (. /etc/os-release && apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT) $(ORIGIN)' \
        'Identifier: Packages' | awk -v release="$VERSION_CODENAME" -v origin="$ID" \
        '$2 == release && tolower($4) == origin && !seen[$0]++ { print $1, $2, $3 }')
}

make_root() {
    [ "$(id -u)" -eq 0 ] || { echo "not root"; return 1; }
    command -v apt-get && unshare --mount true || return 1
    apt-get -q update || true
    command -v debootstrap || apt-get -q install -y --no-install-recommends debootstrap || return 1
    # shellcheck disable=SC2046 # three words
    set -- $(sources | head -n 1)
    [ $# -eq 3 ] || { echo "apt has no mirror"; return 1; }
    sections=$(sources | awk -v uri="$1" '$1 == uri { print $3 }' | paste -s -d ,)
    eval "$(apt-config shell http_proxy Acquire::http::Proxy https_proxy Acquire::https::Proxy)"
    export ${http_proxy:+http_proxy} ${https_proxy:+https_proxy}
    debootstrap --variant=minbase --components="$sections" "$2" "$root" "$1" || return 1
    apt-config dump | grep -E '^Acquire::(https?|ftp|Retries|Check-|Allow)' >"$root/etc/apt/apt.conf.d/90machine"
    cp /etc/resolv.conf "$root/etc/"
}

in_root() { # in_root COMMAND...: runs it in a namespace whose mounts end with it
    unshare --mount sh -euc 'root=$1; shift
        mount -t proc proc "$root/proc"
        mount --rbind /dev "$root/dev"
        exec chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb \
            ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} "$@"' sh "$root" "$@"
}

git diff --quiet HEAD -- || echo "fresh: the clone does not contain uncommitted changes"
if make_root >"$work/log" 2>&1; then
    echo "fresh: in a minimal root: $(sed -n 's/^PRETTY_NAME=//p' "$root/etc/os-release")," \
        "$(find "$root/var/lib/dpkg/info" -name '*.list' | wc -l) packages"
    git clone -q "$tree" "$root/root/clone"
    enter="in_root sh -c"
    folder=/root/clone
else
    echo "fresh: no minimal root ($(tail -n 1 "$work/log")): a clean clone on this machine instead"
    git clone -q "$tree" "$work/clone"
    enter="env -u PTRIANGLE_BUILD sh -c"
    folder=$work/clone
fi
for command in $commands; do
    echo "fresh: $command"
    start=$(date +%s)
    $enter "cd $folder && $command"
    echo "fresh: $command: $(($(date +%s) - start)) s"
done
