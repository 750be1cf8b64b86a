#!/bin/sh
# Install a build into an empty prefix, then use it as others would: every header alone in C and in C++, a
# program through pkg-config (shared and static) and through find_package.
#
#     run.sh BUILD_FOLDER WORK_FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$1 work=$2
cc=${CC:-cc} cxx=${CXX:-c++}
rm -rf "$work"
mkdir -p "$work"
cmake --install "$build" --prefix "$work/prefix" >/dev/null
prefix=$work/prefix

for header in "$prefix"/include/jali/*.h; do
    $cc -std=c17 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$prefix/include" -x c "$header"
    $cxx -std=c++17 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$prefix/include" -x c++ "$header"
    name=${header##*/}
    if [ "$name" != jali.h ] && ! grep -q "<jali/$name>" "$prefix/include/jali/jali.h"; then
        echo "jali.h promises all headers and does not bring $name"
        exit 1
    fi
done
echo "headers: each compiles alone in C17 and in C++17, and jali.h brings them all"

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name jali.pc)")
lib=$(dirname "$PKG_CONFIG_PATH")
export PKG_CONFIG_PATH
LD_LIBRARY_PATH=$lib
export LD_LIBRARY_PATH
# shellcheck disable=SC2046
$cc -std=c17 "$here/program.c" -o "$work/shared" $(pkg-config --cflags --libs jali)
"$work/shared"
# shellcheck disable=SC2046
$cc -std=c17 "$here/program.c" -o "$work/static" $(pkg-config --cflags jali) "$lib/libjali.a" \
    $(pkg-config --static --libs jali | sed 's/-ljali\b//')
(unset LD_LIBRARY_PATH && "$work/static")
echo "pkg-config: shared and static"

cmake -S "$here" -B "$work/package" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$work/package" >/dev/null
(unset LD_LIBRARY_PATH && "$work/package/by_shared" && "$work/package/by_static")
echo "find_package: shared and static"

# Nothing but jali_ leaves the shared library.
if nm -D --defined-only "$lib/libjali.so" | awk '$2 != "A" { print $3 }' | grep -v '^jali_'; then
    echo "the shared library exports names without jali_"
    exit 1
fi
"$prefix/bin/jali" list samples >/dev/null
