# Writes OUT, a C++ source with the texts FILES (joined in order) as `extern const std::string_view NAME` of namespace
# bough::report. Bytes, not a literal: compilers limit the length of those.
#   cmake -DOUT=file.cpp -DNAME=view_script "-DFILES=a.js;b.js" -P EmbedText.cmake
set(hex "")
foreach(file IN LISTS FILES)
  file(READ "${file}" part HEX)
  string(APPEND hex "${part}")
endforeach()
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
file(WRITE "${OUT}.new" "#include <string_view>
namespace bough::report {
namespace {
constexpr unsigned char bytes[] = {${bytes}};
}
extern const std::string_view ${NAME};
const std::string_view ${NAME}{reinterpret_cast<const char*>(bytes), sizeof bytes};
}  // namespace bough::report
")
execute_process(COMMAND ${CMAKE_COMMAND} -E copy_if_different "${OUT}.new" "${OUT}")
file(REMOVE "${OUT}.new")
