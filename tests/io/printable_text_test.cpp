/// What reaches a terminal, and the hash that files are told apart by.
#include "bough/io/printable_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bough/io/digest.hpp"

namespace bough::io {
namespace {

TEST(Printable, text_passes_and_commands_to_a_terminal_do_not) {
  EXPECT_EQ(printable("Träger, 10 µm\n\ttab"), "Träger, 10 µm\n\ttab");
  EXPECT_EQ(printable("\x1b[31mred\x07\r"), "\\x1b[31mred\\x07\\x0d");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b") << "CSI in one character";
  EXPECT_EQ(printable("\xe2\x80\xae"), "\\xe2\\x80\\xae") << "text from right to left";
  EXPECT_EQ(printable("\xff\xc3(\xe2\x82"), "\\xff\\xc3(\\xe2\\x82") << "not UTF-8";
  EXPECT_EQ(printable("\xed\xa0\x80\xc0\xaf"), "\\xed\\xa0\\x80\\xc0\\xaf") << "a surrogate, an overlong form";
}

TEST(Printable, any_bytes_become_text_without_control_characters) {
  std::mt19937 random(7);
  for (int k = 0; k < 2000; ++k) {
    std::string bytes(random() % 12, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random() % 4 == 0 ? 0xe2 : random());
    std::string_view text = bytes;
    const std::string safe = printable(text);
    for (std::string_view rest = safe; !rest.empty();) {
      const std::size_t length = utf8_length(rest);
      ASSERT_GT(length, 0u);
      if (length == 1) {
        ASSERT_TRUE(rest[0] == '\n' || rest[0] == '\t' || (rest[0] >= ' ' && rest[0] != '\x7f'));
      }
      rest.remove_prefix(length);
    }
    EXPECT_EQ(printable(safe), safe) << "once is enough";
  }
}

TEST(Digest, does_not_depend_on_how_the_bytes_come) {
  std::string bytes;
  for (int k = 0; k < 1000; ++k) bytes += static_cast<char>(k * 37 % 251);
  const std::string whole = digest_of(bytes);
  for (const std::size_t piece : {1u, 3u, 8u, 9u, 31u, 32u, 33u, 64u, 999u}) {
    Digest digest;
    for (std::size_t at = 0; at < bytes.size(); at += piece) digest.add(std::string_view(bytes).substr(at, piece));
    EXPECT_EQ(digest.text(), whole) << piece;
  }
}

TEST(Digest, changes_with_every_bit_and_with_the_length) {
  const std::string bytes(90, 'x');  // two stripes of 32 and a rest
  for (std::size_t k = 0; k < 8 * bytes.size(); ++k) {
    std::string other = bytes;
    other[k / 8] = static_cast<char>(other[k / 8] ^ (1 << (k % 8)));
    EXPECT_NE(digest_of(other), digest_of(bytes)) << k;
  }
  EXPECT_NE(digest_of(std::string(3, '\0')), digest_of(std::string(4, '\0')));
  EXPECT_NE(digest_of(""), digest_of(std::string(8, '\0')));
  EXPECT_NE(digest_of(""), digest_of(std::string(32, '\0')));
}

TEST(Digest, changes_with_the_order_of_words_and_stripes) {
  std::string bytes;
  for (int k = 0; k < 96; ++k) bytes += static_cast<char>(k);
  for (const std::size_t size : {1u, 8u, 16u, 32u})
    for (std::size_t from = size; from + size <= bytes.size(); from += size) {
      std::string other = bytes;
      std::swap_ranges(other.begin(), other.begin() + static_cast<std::ptrdiff_t>(size),
                       other.begin() + static_cast<std::ptrdiff_t>(from));
      EXPECT_NE(digest_of(other), digest_of(bytes)) << size << " " << from;
    }
}

}  // namespace
}  // namespace bough::io
