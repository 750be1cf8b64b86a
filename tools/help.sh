#!/bin/sh
# Print a page with each of its `console` blocks replaced by what the command in it says now.
#
#     tools/help.sh JALI PAGE
set -eu
awk -v jali="$1" '
    old && /^```$/ { old = 0 }
    !old { print }
    block && /^\$ jali / {
        command = $0
        sub(/^\$ jali/, jali, command)
        while ((command | getline line) > 0) print line
        close(command)
        old = 1
    }
    { block = /^```console$/ }
' "$2"
