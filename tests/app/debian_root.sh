# Sourced by the scripts that run as root in a minimal Debian 12 system. Needs mmdebstrap and Debian's packages.

# make_debian_root FOLDER [INCLUDED_PACKAGES]: installs the system unless it is there, with /proc, /dev, /sys and the network settings of this machine.
make_debian_root() {
  local root=$1
  if [ ! -e "$root/bin/sh" ]; then mmdebstrap --quiet --variant=apt ${2:+--include="$2"} bookworm "$root"; fi
  mount -t proc proc "$root/proc"  # the program finds its library relative to itself
  for folder in /dev /sys; do  # /sys has the control groups, for Slurm
    mount --rbind "$folder" "$root$folder"
    mount --make-rslave "$root$folder"  # unmounting it leaves that of this machine alone
  done
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  printf '127.0.0.1 localhost\n127.0.1.1 %s\n' "$(hostname)" >"$root/etc/hosts"
}

# release_debian_root FOLDER: unmounts.
release_debian_root() { umount -R "$1/proc" "$1/dev" "$1/sys" 2>/dev/null || true; }
