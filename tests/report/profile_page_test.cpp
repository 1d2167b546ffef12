/// The page of a profile: self-contained, every number that names its source is the number there.
#include "bough/report/profile_page.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/profile_json.hpp"

namespace bough::report {
namespace {

using records::Profile;
using records::SubdomainProfile;

/// A root over two leaves of which one was factored in no time worth naming.
Profile make_profile() {
  Profile p;
  p.scene = "two <leaves>";
  p.cut = "by hand";
  p.threads = 2;
  p.steps = 3;
  p.num_visits = 3;
  for (int k = 0; k < 3; ++k) {
    SubdomainProfile s;
    s.id = s.visit = k;
    s.parent = k < 2 ? 2 : -1;
    s.level = k < 2 ? 1 : 0;
    s.is_leaf = k < 2;
    s.num_unknowns = 10 * (k + 1);
    s.subtree_unknowns = k < 2 ? s.num_unknowns : 60;
    s.interface_unknowns = k < 2 ? 6 : 0;
    s.times.factor = 1e-6 * (k + 1);
    s.times.backward = 2e-6;
    if (k < 2) s.condition = 10.0 + k;
    p.subdomains.push_back(s);
  }
  records::sum_subtrees(p.subdomains);
  p.levels = records::sum_levels(p.subdomains);
  p.thread_busy = {1.0, 0.5};
  p.total = 12e-6;
  p.critical_path = 9e-6;
  p.speed = {{1, 12e-6, 1e-3, 13e-6, 1.1e-3, 4e9, 13e-6}, {2, 9e-6, 8e-4}};
  p.walks = {{"factor", 6e-6, 5e-6, 1e4, {6e-6, 5e-6}, {7e-6, 3e-6}}};
  p.parts = {{records::ProfilePart::Kind::beam, 0, {{0, 0, 0}, {1, 0, 0}}},
             {records::ProfilePart::Kind::body, 1, {{2, 0, 0}}},
             {records::ProfilePart::Kind::joint, 1, {{1, 0, 0}, {2, 0, 0}}}};
  p.separator_nodes = {{{1, 0, 0}, 2}};
  p.events = {{"factor", 0, 0, 0, 0.0, 1e-6},
              {"factor", 1, 1, 1, 0.0, 2e-6},
              {"backward", 2, 2, 0, 3e-6, 1e-6},
              {"evaluate", -1, 0, 1, 3e-6, 1e-6},
              {"step", -1, 0, -1, 0.0, 5e-6}};
  p.alternatives = {{0, -1, true, 3, 2, 2, 1e3, 12e-6, 9e-6}, {4, -1, false, 1, 1, 1, 1e3, 11e-6, 11e-6}};
  return p;
}

TEST(ProfilePage, is_one_file_without_scripts) {
  const std::string html = profile_page(make_profile(), "profile.json");
  for (const char* part : {"<script", "src=", "href=\"http", "@import", "url("})
    EXPECT_EQ(html.find(part), std::string::npos) << part;
  EXPECT_NE(html.find("two &lt;leaves&gt;"), std::string::npos);
  EXPECT_EQ(html.find("two <leaves>"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  for (const char* part : {"id=\"icicle-time\"", "id=\"icicle-size\"", "id=\"icicle-condition\"", "id=\"icicle-force\"",
                           "id=\"scene-1\"", "timeline"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(ProfilePage, numbers_are_those_of_the_file) {
  const Profile p = make_profile();
  std::vector<io::JsonFault> faults;
  const std::string text = io::profile_text(p, "0");
  const auto json = io::parse_json(text, io::source_file, faults);
  ASSERT_TRUE(json && faults.empty());
  const std::string html = profile_page(p, "profile.json");
  const std::regex cell(R"rx(<td[^>]*data-source="([^"]+)"[^>]*>([^<]*)</td>)rx");
  int count = 0;
  for (std::sregex_iterator it(html.begin(), html.end(), cell), end; it != end; ++it, ++count) {
    const auto tokens = io::split_pointer((*it)[1].str());
    ASSERT_TRUE(tokens);
    const io::JsonValue* value = &*json;
    for (const std::string& token : *tokens) {
      value = value->is(io::JsonKind::array) ? &value->items.at(std::stoul(token)) : value->find(token);
      ASSERT_NE(value, nullptr) << (*it)[1];
    }
    // The shown text starts with the number up to its unit and prefix: three digits of it are those of the file.
    const std::string shown = (*it)[2];
    if (value->is(io::JsonKind::string)) {  // a number that is none, or the path of a sub-domain
      EXPECT_EQ(shown, value->text == "nan" ? "-" : value->text.str());
      continue;
    }
    const double first = std::strtod(shown.c_str(), nullptr);
    if (value->number == 0.0) {
      EXPECT_EQ(first, 0.0) << shown;
      continue;
    }
    const double decade = std::log10(value->number / first);
    EXPECT_NEAR(decade, std::round(decade / 3.0) * 3.0, 6e-3)
        << (*it)[1] << " " << shown;  // three digits; k, M, ms, us
  }
  EXPECT_GT(count, 60);
}

TEST(ProfilePage, drawings_show_every_part_once) {
  const Profile p = make_profile();
  const std::string icicle = icicle_html(p), scene = subdomains_html(p), timeline = timeline_svg(p);
  const auto count = [](const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
    return n;
  };
  EXPECT_EQ(count(icicle, "</title></rect>"), 3u);  // one for each sub-domain
  EXPECT_EQ(count(scene, "<path"), 3u);
  EXPECT_EQ(count(scene, "<circle"), 1u);
  EXPECT_EQ(count(timeline, "</title></rect>"), 4u);
  // Children share the whole width: the second leaf ends where the drawing does.
  EXPECT_NE(icicle.find("x=\"0\" y=\"26\" width=\"960\""), std::string::npos);
  EXPECT_NE(icicle.find("width=\"640\""), std::string::npos);
  EXPECT_NE(icicle.find("x=\"320\""), std::string::npos);
}

TEST(ProfilePage, an_empty_profile_is_a_page_too) {
  EXPECT_NE(profile_page({}, "profile.json").find("<html"), std::string::npos);
}

}  // namespace
}  // namespace bough::report
