#include "measured_errors.hpp"

#include <cmath>

#include "bough/io/history.hpp"

namespace bough::io {

using records::ErrorOf;
using records::ErrorPart;
using records::ErrorState;

namespace {

const char* word_of(ErrorState state) {
  switch (state) {
    case ErrorState::not_measured:
      return "not measured";
    case ErrorState::resolved:
      return "resolved";
    case ErrorState::unexamined:
      return "order not examined";
    case ErrorState::round_off:
      return "round-off";
    case ErrorState::not_resolved:
      return "not resolved";
  }
  return "";
}

void write_part(JsonText& json, const char* key, const ErrorPart& part) {
  if (part.state == ErrorState::not_measured && part.cause.empty()) return;
  json.key(key);
  json.begin_object();
  json.member("state", std::string_view(word_of(part.state)));
  if (part.state != ErrorState::not_measured) {
    json.member(part.is_known() ? "largest" : "largest_difference", part.largest);
    json.member(part.is_known() ? "root_mean_square" : "root_mean_square_difference", part.root_mean_square);
    json.member("when", part.when);
    if (part.is_known()) json.member("at_end", part.at_end);
    if (part.theoretical_order > 0.0) json.member("theoretical_order", part.theoretical_order);
    if (!std::isnan(part.order_of_largest)) json.member("order_of_largest", part.order_of_largest);
    if (!std::isnan(part.order_of_root_mean_square))
      json.member("order_of_root_mean_square", part.order_of_root_mean_square);
  }
  if (!part.cause.empty()) json.member("cause", std::string_view(part.cause));
  json.end_object();
}

void write_list(JsonText& json, const char* key, const std::vector<ErrorOf>& list) {
  if (list.empty()) return;
  json.key(key);
  json.begin_object();
  for (std::size_t k = 0; k < list.size(); ++k) {
    const ErrorOf& e = list[k];
    std::size_t before = 0;
    for (std::size_t i = 0; i < k; ++i) before += list[i].name == e.name ? 1 : 0;
    json.key(before == 0 ? e.name : e.name + " #" + std::to_string(before + 1));
    json.begin_object();
    json.member("value", e.value);
    if (!e.unit.empty()) json.member("unit", std::string_view(e.unit));
    if (!std::isnan(e.extrapolated)) json.member("extrapolated", e.extrapolated);
    if (e.range > 0.0) json.member("range", e.range);
    write_part(json, "time", e.time);
    write_part(json, "mesh", e.mesh);
    json.end_object();
  }
  json.end_object();
}

}  // namespace

std::string errors_csv(const records::MeasuredErrors& errors) {
  std::string text = history_head(errors.header);
  for (const records::HistoryRow& row : errors.rows) append_history_row(text, row);
  return text;
}

void write_measured_errors(JsonText& json, const records::MeasuredErrors& errors) {
  json.key("errors");
  json.begin_object();
  json.key("twins");
  json.begin_array();
  for (const records::TwinMember& m : errors.members) {
    json.begin_object();
    json.member("of", std::string_view(m.is_of_mesh ? "mesh" : "time"));
    json.member("factor", m.factor);
    json.member("ran", m.status == records::RunStatus::ok);
    if (!m.cause.empty()) json.member("cause", std::string_view(m.cause));
    json.member("time_s", m.seconds);
    json.end_object();
  }
  json.end_array();
  write_list(json, "columns", errors.columns);
  write_list(json, "expected", errors.expected);
  write_list(json, "measures", errors.measures);
  json.key("remarks");
  json.begin_array();
  for (const std::string& remark : errors.remarks) json.value(std::string_view(remark));
  json.end_array();
  json.end_object();
}

}  // namespace bough::io
