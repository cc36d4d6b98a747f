#!/bin/sh
# Tests and measures neurotess on this machine's graphics hardware: needs a driver, and nothing else. Writes to its own
# folder only. `./run.sh --help` lists the options.
set -u
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd) || exit 1

# Libraries that the system does not have: the Vulkan loader, and what drivers load.
missing=
for library in "$here"/libraries/*/*; do
    if ! /sbin/ldconfig -p 2>/dev/null | grep -q "$(basename "$library")"; then
        missing=${missing:+$missing:}$(dirname "$library")
    fi
done
if [ -n "$missing" ]; then
    LD_LIBRARY_PATH=${LD_LIBRARY_PATH:+$LD_LIBRARY_PATH:}$missing
    export LD_LIBRARY_PATH
fi

# Drivers that lie where the loader does not look, as in some containers.
if [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ]; then
    for driver in /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json /usr/local/share/vulkan/icd.d/*.json; do
        [ -e "$driver" ] && found=$driver
    done
    if [ -z "${found:-}" ]; then
        for driver in /usr/local/*/share/vulkan/icd.d/*.json /opt/*/share/vulkan/icd.d/*.json; do
            [ -e "$driver" ] && VK_DRIVER_FILES=${VK_DRIVER_FILES:+$VK_DRIVER_FILES:}$driver
        done
        [ -n "${VK_DRIVER_FILES:-}" ] && export VK_DRIVER_FILES
    fi
fi

exec "$here/xtask" gpu-run "$here" "$@"
