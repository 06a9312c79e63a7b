#!/bin/sh
# Downloads Debian packages for another architecture, or sources, without changing the system: uses a separate apt in
# FOLDER/apt. Usage: private_apt.sh FOLDER deb|deb-src ARCHITECTURE; then APT_CONFIG=FOLDER/apt/conf apt-get ...
set -eu
apt=$1/apt
mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial" "$apt/parts"
: >"$apt/status"
cat >"$apt/parts/debian.sources" <<EOF
Types: $2
URIs: http://deb.debian.org/debian
Suites: $(. /etc/os-release && echo "$VERSION_CODENAME")
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
EOF
cat >"$apt/conf" <<EOF
APT::Architecture "$3";
APT::Architectures { "$3"; };
APT::Sandbox::User "root";
Acquire::Languages "none";
Dir::State::Lists "$apt/lists";
Dir::State::status "$apt/status";
Dir::Cache "$apt/cache";
Dir::Etc::SourceList "/dev/null";
Dir::Etc::SourceParts "$apt/parts";
EOF
APT_CONFIG=$apt/conf apt-get -qq update
