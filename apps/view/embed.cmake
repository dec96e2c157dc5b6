# Writes OUTPUT, which holds FILES (parted by |) as bytes and their names. Run by cmake -P.
set(arrays "")
set(table "")
set(number 0)
string(REPLACE "|" ";" FILES "${FILES}")
foreach(file ${FILES})
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${hex}")
  string(REGEX REPLACE "(('[^']*',){32})" "\\1\n" bytes "${bytes}")
  string(LENGTH "${hex}" digits)
  math(EXPR size "${digits} / 2")
  get_filename_component(name ${file} NAME)
  string(APPEND arrays "constexpr char kFile${number}[] = {${bytes}0};\n")
  string(APPEND table "  {\"${name}\", {kFile${number}, ${size}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"apps/view/page_files.h\"\n\nnamespace nullcone::view {\n\nnamespace {\n${arrays}
constexpr PageFile kFiles[] = {\n${table}};\n}  // namespace\n
std::span<const PageFile> page_files() { return kFiles; }\n\n}  // namespace nullcone::view\n")
