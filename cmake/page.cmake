# Make a C file that holds the page, each file compressed: cmake -DOUT=FILE -DFROM=FOLDER -P page.cmake
# (A script of its own, so that it runs again when the page changes.)
file(GLOB_RECURSE files RELATIVE ${FROM} ${FROM}/*)
list(SORT files)
set(arrays "")
set(records "")
set(count 0)
foreach(name ${files})
  file(ARCHIVE_CREATE OUTPUT ${OUT}.gz PATHS ${FROM}/${name} FORMAT raw COMPRESSION GZip COMPRESSION_LEVEL 9)
  file(SIZE ${FROM}/${name} whole)
  file(READ ${OUT}.gz bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "static const unsigned char file_${count}[] = {${bytes}};\n")
  string(APPEND records "    {\"/${name}\", file_${count}, sizeof file_${count}, ${whole}},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(REMOVE ${OUT}.gz)
file(WRITE ${OUT} "// The files of web/dist, as the build found them.
#include \"page.h\"

${arrays}
const int32_t page_file_count = ${count};
const page_file page_files[] = {
${records}};
")
