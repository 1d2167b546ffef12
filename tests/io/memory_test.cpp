// What reading a file takes, in bytes allocated at a time: below 30 times the file, whatever it holds, and little
// more for what is wrong with it.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <string>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"

namespace {

std::size_t now = 0, peak = 0;

void* take(std::size_t bytes) {
  void* p = std::malloc(bytes == 0 ? 1 : bytes);
  if (p == nullptr) throw std::bad_alloc();
  now += malloc_usable_size(p) + 8;  // with the allocator's own
  peak = std::max(peak, now);
  return p;
}
void give(void* p) noexcept {
  if (p != nullptr) now -= malloc_usable_size(p) + 8;
  std::free(p);
}

}  // namespace

void* operator new(std::size_t bytes) { return take(bytes); }
void* operator new[](std::size_t bytes) { return take(bytes); }
void operator delete(void* p) noexcept { give(p); }
void operator delete[](void* p) noexcept { give(p); }
void operator delete(void* p, std::size_t) noexcept { give(p); }
void operator delete[](void* p, std::size_t) noexcept { give(p); }

namespace bough::io {
namespace {

/// Peak of what f takes, over the size of the text.
template <class F>
double peak_per_byte(const std::string& text, F&& f) {
  const std::size_t before = now;
  peak = now;
  f(text);
  return static_cast<double>(peak - before) / static_cast<double>(text.size());
}

std::string repeated(const std::string& first, const std::string& item, const std::string& last) {
  std::string text = first;
  while (text.size() < 300'000) text += item;
  return text + last;
}

TEST(Memory, a_text_takes_less_than_30_times_its_size) {
  for (const char* item : {"{},", "1,", "0.125,", "[],", "[1],", "[[1]],", "\"\",", "\"a\",", "{\"\":1},",
                           "{\"a\":{}},", "{\"name\":\"x\",\"position\":[1,2,3]},", "true,", "[1,2],"})
    EXPECT_LT(peak_per_byte(repeated("{\"nodes\":[", item, "0]}"),
                            [](const std::string& text) {
                              std::vector<JsonFault> faults;
                              EXPECT_TRUE(parse_json(text, source_file, faults));
                            }),
              30.0)
        << item;
}

TEST(Memory, one_object_of_many_keys_takes_less_than_30_times_its_size) {
  std::string text = "{";
  for (int i = 0; i < 30'000; ++i) text += "\"k" + std::to_string(i) + "\":1,";
  text += "\"end\":0}";
  EXPECT_LT(peak_per_byte(text,
                          [](const std::string& t) {
                            std::vector<JsonFault> faults;
                            EXPECT_TRUE(parse_json(t, source_file, faults));
                          }),
            30.0);
}

/// Each of the items misses keys: no fault of millions is kept, no default given to what is wrong.
TEST(Memory, faults_by_the_thousand_take_little_more) {
  for (const char* list : {"nodes", "beams", "bodies", "joints", "loads", "sensors", "springs", "sections"})
    EXPECT_LT(peak_per_byte(repeated(std::string("{\"") + list + "\":[", "{},", "{}]}"),
                            [](const std::string& text) {
                              const SceneFile file = read_scene_text(text, "many");
                              ASSERT_FALSE(file.ok());
                              EXPECT_LE(file.problems.size(), max_problems);
                              EXPECT_NE(file.problems.back().hint.find("more problems are not shown"),
                                        std::string::npos);
                            }),
              32.0)
        << list;
}

}  // namespace
}  // namespace bough::io
