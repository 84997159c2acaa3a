# Writes text files as string constants of C++:
#   cmake -DOUT=assets.cc -DNAMES=kOne;kOther -DFILES=one.css;other.js -P embed.cmake
set(text "#include \"render/report/assets.h\"\n\nnamespace patrol::render {\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
  file(READ "${file}" content)
  string(APPEND text "const std::string_view ${name} = R\"patrol(${content})patrol\";\n")
endforeach()
string(APPEND text "}  // namespace patrol::render\n")
file(WRITE "${OUT}" "${text}")
