#!/bin/sh
# The page in Debian's Chromium (web/tests), where Node 20 and Chromium are; else 77, which ctest calls skipped.
#
#     tools/page_test.sh JALI
set -eu
skip() { echo "skipped: $1"; exit 77; }
command -v node >/dev/null || skip "there is no node"
[ "$(node -p 'Number(process.versions.node.split(".")[0])')" -ge 20 ] || skip "node is $(node -v); the page's tests need 20"
CHROMIUM=$(command -v chromium) || skip "there is no chromium"
JALI=$(realpath "$1")
cd "$(dirname "$0")/../web"
[ -d node_modules/playwright-core ] && [ -d node_modules/axe-core ] || npm ci --no-audit --no-fund --silent ||
    skip "npm cannot fetch what package-lock.json names"
JALI=$JALI CHROMIUM=$CHROMIUM exec node --test tests/*.test.mjs
