#pragma once
/// Text from files and names of files, made fit for a terminal.
#include <cstddef>
#include <string>
#include <string_view>

namespace bough::io {

/// Number of bytes of the UTF-8 character at the start of `text`, 0 where there is none (RFC 3629: no overlong forms,
/// no surrogates).
std::size_t utf8_length(std::string_view text);

/// Appends the character of `length` bytes at the start of `text`, as `utf8_length` gives it (0: one byte that is not
/// UTF-8). Whatever would make a terminal do something else than show a character is written as \xHH: control
/// characters but line feed and tab, bytes that are not UTF-8, and the marks that reverse the direction of text.
void append_printable(std::string& to, std::string_view text, std::size_t length);

/// The whole text, made printable.
std::string printable(std::string_view text);

}  // namespace bough::io
