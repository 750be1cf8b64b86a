# Make a C file that holds the built-in printer profiles: cmake -DOUT=FILE -DFROM=FOLDER -P embed.cmake
# (A script of its own, so that it runs again when a profile changes.)
file(GLOB profiles ${FROM}/*.json)
list(SORT profiles)
set(arrays "")
set(names "")
set(records "")
set(count 0)
foreach(profile ${profiles})
  get_filename_component(name ${profile} NAME)
  string(REGEX REPLACE "\\.json$" "" name ${name})
  file(READ ${profile} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "static const char profile_${count}[] = {${bytes}};\n")
  string(APPEND names "    \"${name}\",\n")
  string(APPEND records "    {profile_${count}, sizeof profile_${count}},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUT} "// The files of printers/, as the build found them.
#include \"printer/profile.h\"

${arrays}
const int32_t builtin_count = ${count};
const char *const builtin_name[] = {
${names}};
const builtin_profile builtin_profiles[] = {
${records}};
")
