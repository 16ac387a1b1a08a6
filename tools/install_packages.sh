# Sourced by tools/build: install_packages LIST_FILE installs those Debian packages of the list that are missing.
# Where it may not (no root, no sudo) it prints the command that somebody else has to run.

install_packages() {
  local wanted missing="" package
  wanted=$(grep -v '^#' "$1")
  for package in $wanted; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing="$missing $package"
  done
  [ -n "$missing" ] || return 0

  local as_root=""
  if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null 2>&1; then
      as_root=sudo
    else
      echo "Missing Debian packages; as root, run: apt-get install --no-install-recommends$missing" >&2
      return 1
    fi
  fi
  echo "Installing missing packages:$missing"
  $as_root apt-get update -qq </dev/null || return 1
  $as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0 $missing </dev/null >/dev/null || {
    echo "apt-get install failed; try it by hand: apt-get install --no-install-recommends$missing" >&2
    return 1
  }
}
