# Writes text files as string constants of C++, which HEADER declares in namespace SPACE:
#   cmake -DOUT=assets.cc -DHEADER=monitor/assets.h -DSPACE=patrol::monitor -DNAMES=kOne;kOther -DFILES=one.css;other.js -P embed.cmake
set(text "#include \"${HEADER}\"\n\nnamespace ${SPACE} {\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
  file(READ "${file}" content)
  string(APPEND text "const std::string_view ${name} = R\"patrol(${content})patrol\";\n")
endforeach()
string(APPEND text "}  // namespace ${SPACE}\n")
file(WRITE "${OUT}" "${text}")
