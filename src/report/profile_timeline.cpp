/// Visits and chunks on a timeline, by thread, over a few steps.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "bough/io/quantity_text.hpp"
#include "bough/report/profile_page.hpp"
#include "svg_text.hpp"

namespace bough::report {

namespace {

using records::Profile;
using records::ProfileEvent;

constexpr double left = 70.0, right = 950.0, top = 44.0, row_height = 34.0, row_gap = 8.0;  // [px]
constexpr std::size_t most_bars = 4000;
constexpr double same_spot = 0.25;

struct Kind {
  const char* work;
  const char* label;
  const char* style;
};
constexpr Kind kinds[] = {{"factor", "factor", "s0 solid"},
                          {"evaluate", "evaluate", "s1 solid"},
                          {"backward", "back-substitute", "s2 solid"},
                          {"forward", "forward", "s3 solid"},
                          {"residual", "check", "s4 solid"},
                          {"other", "other loops", "s5 solid"}};

const char* style_of(const ProfileEvent& e) {
  for (const Kind& k : kinds)
    if (std::strcmp(k.work, e.work) == 0) return k.style;
  return "s5 solid";
}

/// End of the time window: two whole steps, or fewer if these have too many bars.
double window_end(const std::vector<const ProfileEvent*>& steps, const std::vector<const ProfileEvent*>& bars) {
  double end = bars.back()->begin + bars.back()->seconds;
  if (!steps.empty()) {
    const ProfileEvent& last = *steps[std::min<std::size_t>(1, steps.size() - 1)];
    end = std::min(end, last.begin + last.seconds);
  }
  if (bars.size() > most_bars) end = std::min(end, bars[most_bars]->begin);
  return end;
}

}  // namespace

std::string timeline_svg(const Profile& p) {
  std::vector<const ProfileEvent*> steps, bars;
  for (const ProfileEvent& e : p.events) (e.thread < 0 ? steps : bars).push_back(&e);
  if (bars.empty()) return {};
  const auto by_begin = [](const ProfileEvent* a, const ProfileEvent* b) { return a->begin < b->begin; };
  std::sort(bars.begin(), bars.end(), by_begin);
  std::sort(steps.begin(), steps.end(), by_begin);
  const double begin = steps.empty() ? bars.front()->begin : std::min(steps.front()->begin, bars.front()->begin);
  const double end = window_end(steps, bars);
  const double scale = (right - left) / std::max(end - begin, 1e-12);
  const auto num_threads = std::max<std::size_t>(p.thread_busy.size(), 1);
  const double height = top + (row_height + row_gap) * static_cast<double>(num_threads) + 24.0;
  std::string body =
      "<svg viewBox=\"0 0 960 " + pixel(height) +
      "\" role=\"img\" aria-label=\"timeline of tasks\">\n<rect class=\"paper\" x=\"0\" y=\"0\" width=\"960\" "
      "height=\"" +
      pixel(height) + "\"/>\n";
  double x = left;
  for (const Kind& k : kinds) {
    body += "<rect class=\"" + std::string(k.style) + "\" stroke=\"none\" x=\"" + pixel(x) +
            "\" y=\"8\" width=\"12\" height=\"12\"/>\n" + text_element("tiny soft", x + 17.0, 18.0, "start", k.label);
    x += 130.0;
  }
  constexpr double label_width = 30.0;
  double free_from = 0.0;  // right end of the previous label
  for (const ProfileEvent* s : steps) {
    if (s->begin >= end) break;
    const double at = left + scale * (s->begin - begin);
    body += line_element("axis", at, top - 16.0, at, height - 20.0);
    const bool has_room = at >= free_from && at + 4.0 + label_width <= 960.0;
    if (!has_room) continue;
    body += text_element("tiny soft", at + 4.0, top - 6.0, "start", "step");
    free_from = at + 4.0 + label_width;
  }
  for (std::size_t t = 0; t < num_threads; ++t)
    body += text_element("tiny ink", left - 8.0, top + (row_height + row_gap) * static_cast<double>(t) + 21.0, "end",
                         "thread " + std::to_string(t));
  struct Bar {
    double from = -1.0, to = -1.0;
    const ProfileEvent* event = nullptr;
    int count = 0;
  };
  std::vector<Bar> open(num_threads);
  const auto draw = [&body](const Bar& bar) {
    if (bar.event == nullptr) return;
    const double y = top + (row_height + row_gap) * bar.event->thread;
    const std::string what = bar.count > 1 ? std::to_string(bar.count) + " times " + bar.event->work
                             : bar.event->visit >= 0
                                 ? std::string(bar.event->work) + ", visit " + std::to_string(bar.event->visit)
                                 : std::string(bar.event->work) + ", items from " + std::to_string(bar.event->item);
    body += "<rect class=\"" + std::string(style_of(*bar.event)) + "\" stroke=\"none\" x=\"" + pixel(bar.from) +
            "\" y=\"" + pixel(y) + "\" width=\"" + pixel(std::max(0.15, bar.to - bar.from)) + "\" height=\"" +
            pixel(row_height) + "\"><title>" +
            escaped(what + (bar.count > 1 ? "" : ": " + io::seconds_text(bar.event->seconds))) + "</title></rect>\n";
  };
  for (const ProfileEvent* e : bars) {
    if (e->begin >= end || e->thread < 0 || static_cast<std::size_t>(e->thread) >= num_threads) continue;
    const double from = left + scale * (e->begin - begin);
    const double to = std::min(right, from + scale * e->seconds);
    Bar& bar = open[static_cast<std::size_t>(e->thread)];
    const bool is_small = to - from < 1.0 && bar.to - bar.from < 3.0;
    if (bar.event != nullptr && is_small && from - bar.to < same_spot && std::strcmp(bar.event->work, e->work) == 0) {
      bar.to = std::max(bar.to, to);
      ++bar.count;
      continue;
    }
    draw(bar);
    bar = {from, to, e, 1};
  }
  for (const Bar& bar : open) draw(bar);
  return body + text_element("tiny soft", left, height - 6.0, "start", "0") +
         text_element("tiny soft", right, height - 6.0, "end", io::seconds_text(end - begin)) + "</svg>\n";
}

}  // namespace bough::report
