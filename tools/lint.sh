#!/bin/sh
# The layout, clang-tidy and cppcheck over the tree; silent when there is nothing to say.
#
#     tools/lint.sh BUILD_FOLDER    (for its compile_commands.json)
set -eu
build=$1
status=0
git ls-files '*.c' '*.h' | xargs clang-format --dry-run -Werror || status=1
# gcc's own flags mean nothing to clang.
mkdir -p "$build/lint"
sed 's/-fno-tree-slp-vectorize//g' "$build/compile_commands.json" >"$build/lint/compile_commands.json"
git ls-files 'src/*.c' 'cli/*.c' 'serve/*.c' 'svg/*.c' 'bench/*.c' |
    xargs -n 4 -P "$(nproc)" clang-tidy --quiet -p "$build/lint" 2>"$build/lint/log" || status=1
cppcheck --quiet --std=c11 --enable=warning,performance,portability --inline-suppr --error-exitcode=1 \
    --suppress=missingIncludeSystem --suppress=normalCheckLevelMaxBranches --library=posix -D_GNU_SOURCE \
    -I include -I src -I cli -I serve -I . src cli serve svg || status=1
exit $status
