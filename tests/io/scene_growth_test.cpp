// The cost of reading a scene is in proportion to its text, whatever is in it.
#include <gtest/gtest.h>

#include "bough/io/read_scene.hpp"
#include "support/growth.hpp"

namespace bough::io {
namespace {

/// A scene of n items of each list, item(i) being the text of one.
struct List {
  const char* key;
  std::function<std::string(int)> item;
};

std::string scene_text(int n, const std::vector<List>& lists, const std::string& more) {
  std::string text = R"({"schema_version": 1, "analysis": {"kind": "dynamic", "end_time": 1})" + more;
  for (const List& list : lists) {
    text += std::string(", \"") + list.key + "\": [";
    for (int i = 0; i < n; ++i) text += (i == 0 ? "" : ",\n") + list.item(i);
    text += "]";
  }
  return text + "}";
}

/// A name of 60 characters, as long for all i: names that begin alike are compared to their ends.
std::string name(const char* stem, int i) {
  const std::string number = std::to_string(i);
  return std::string(stem) + std::string(60 - std::string_view(stem).size() - number.size(), '_') + number;
}

std::string body(int i) { return R"({"name": "b)" + std::to_string(i) + R"(", "mass": 1, "inertia": [1, 1, 1]})"; }

/// Formulas that name the last of all signals cost what those cost that name the first.
TEST(ReaderGrowth, of_formulas_does_not_depend_on_the_place_of_the_signal_that_they_name) {
  constexpr int n = 16000;
  const auto named = [](int place) {
    return scene_text(n,
                      {{"signals",
                        [place](int i) {
                          const std::string own = R"({"name": ")" + name("s", i) + R"(", "kind": )";
                          return i == place ? own + R"("time", "law": 1})"
                                            : own + R"("formula", "expression": ")" + name("s", place) + R"("})";
                        }}},
                      R"(, "bodies": [)" + body(0) + "]");
  };
  const std::string first = named(0), last = named(n - 1);
  ASSERT_TRUE(read_scene_text(last, "last").ok());
  const double of_first = test::least_seconds([&] { (void)read_scene_text(first, "first"); }),
               of_last = test::least_seconds([&] { (void)read_scene_text(last, "last"); });
  EXPECT_LT(of_last, 1.5 * of_first);
}

}  // namespace
}  // namespace bough::io
