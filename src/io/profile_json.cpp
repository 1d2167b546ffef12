#include "bough/io/profile_json.hpp"

#include <span>

#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"

namespace bough::io {

namespace {

void write_times(JsonText& json, const records::SubdomainTimes& t) {
  json.key("seconds");
  json.begin_object();
  json.member("evaluate", t.evaluate);
  json.member("assemble", t.assemble);
  json.member("factor", t.factor);
  json.member("condense", t.condense);
  json.member("forward", t.forward);
  json.member("backward", t.backward);
  json.member("move", t.move);
  json.member("residual", t.residual);
  json.member("wait", t.wait);
  json.end_object();
}

void write_numbers(JsonText& json, const char* name, std::span<const double> numbers) {
  json.key(name);
  json.begin_array();
  for (const double v : numbers) json.value(v);
  json.end_array();
}

void write_subdomain(JsonText& json, const records::SubdomainProfile& s) {
  json.begin_object();
  json.member("id", static_cast<long long>(s.id));
  json.member("parent", static_cast<long long>(s.parent));
  json.member("level", static_cast<long long>(s.level));
  json.member("visit", static_cast<long long>(s.visit));
  json.member("in_visit", static_cast<long long>(s.num_in_visit));
  json.member("leaf", s.is_leaf);
  json.member("elements", static_cast<long long>(s.num_elements));
  json.member("fronts", static_cast<long long>(s.num_fronts));
  json.member("unknowns", static_cast<long long>(s.num_unknowns));
  json.member("subtree_unknowns", static_cast<long long>(s.subtree_unknowns));
  json.member("interface_unknowns", static_cast<long long>(s.interface_unknowns));
  json.member("factor_entries", static_cast<long long>(s.factor_entries));
  json.member("fill", static_cast<long long>(s.fill));
  json.member("flops", s.flops);
  json.member("subtree_flops", s.subtree_flops);
  json.member("bytes", s.bytes);
  json.member("thread", static_cast<long long>(s.thread));
  write_times(json, s.times);
  json.member("subtree_seconds", s.subtree_seconds);
  json.member("path", s.path);
  json.key("interface");
  json.begin_array();
  for (const records::InterfaceNode& n : s.nodes) {
    json.begin_object();
    json.member("node", n.name);
    write_numbers(json, "place", n.place);
    write_numbers(json, "force", n.force);
    write_numbers(json, "moment", n.moment);
    json.end_object();
  }
  json.end_array();
  json.member("condition", s.condition);
  write_numbers(json, "spectrum", s.spectrum);
  json.end_object();
}

void write_level(JsonText& json, const records::LevelProfile& l) {
  json.begin_object();
  json.member("level", static_cast<long long>(l.level));
  json.member("sub_domains", static_cast<long long>(l.num_subdomains));
  json.member("unknowns", static_cast<long long>(l.num_unknowns));
  json.member("interface_unknowns_max", static_cast<long long>(l.interface_unknowns_most));
  json.member("fill", static_cast<long long>(l.fill));
  json.member("flops", l.flops);
  json.member("bytes", l.bytes);
  write_times(json, l.times);
  json.member("condition_max", l.condition_most);
  json.end_object();
}

void write_run(JsonText& json, const records::Profile& p) {
  json.key("run");
  json.begin_object();
  json.member("threads", static_cast<long long>(p.threads));
  json.member("machine_threads", static_cast<long long>(p.machine_threads));
  json.member("steps", static_cast<long long>(p.steps));
  json.member("factorizations", static_cast<long long>(p.factorizations));
  json.member("solutions", static_cast<long long>(p.solutions));
  json.end_object();
  json.key("step");
  json.begin_object();
  json.member("total", p.step.total);
  json.member("evaluate", p.step.evaluate);
  json.member("factor", p.step.factor);
  json.member("forward", p.step.forward);
  json.member("backward", p.step.backward);
  json.member("residual", p.step.residual);
  json.member("other_chunks", p.step.other_chunks);
  json.member("rest", p.step.rest);
  json.member("factorizations", p.step.factorizations);
  json.member("condensations", p.step.condensations);
  json.member("solutions", p.step.solutions);
  json.member("checks", p.step.checks);
  json.member("evaluations", p.step.evaluations);
  json.member("walks", p.step.walks);
  json.end_object();
}

void write_speed(JsonText& json, const records::Profile& p) {
  json.key("solution");
  json.begin_object();
  json.member("total", p.total);
  json.member("critical_path", p.critical_path);
  json.member("load_balance", p.load_balance);
  json.member("efficiency", p.efficiency);
  json.key("thread_busy");
  json.begin_array();
  for (double b : p.thread_busy) json.value(b);
  json.end_array();
  json.key("threads");
  json.begin_array();
  for (const records::ThreadsProfile& t : p.speed) {
    json.begin_object();
    json.member("threads", static_cast<long long>(t.threads));
    json.member("predicted", t.predicted);
    json.member("measured", t.measured);
    json.member("predicted_step", t.predicted_step);
    json.member("measured_step", t.measured_step);
    json.member("read_rate", t.read_rate);
    json.member("predicted_with_memory", t.predicted_with_memory);
    json.end_object();
  }
  json.end_array();
  json.key("walks");
  json.begin_array();
  for (const records::WalkProfile& w : p.walks) {
    json.begin_object();
    json.member("work", std::string_view(w.work));
    json.member("total", w.total);
    json.member("critical_path", w.critical_path);
    json.member("bytes", w.bytes);
    json.key("seconds");
    json.begin_array();
    for (double s : w.seconds) json.value(s);
    json.end_array();
    json.key("memory_seconds");
    json.begin_array();
    for (double s : w.memory_seconds) json.value(s);
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

void write_alternatives(JsonText& json, const records::Profile& p) {
  json.key("costs");
  json.begin_array();
  for (const records::CostFit& c : p.costs) {
    json.begin_object();
    json.member("in_lanes", c.in_lanes);
    json.member("visits", static_cast<long long>(c.num_visits));
    json.member("seconds_per_front", c.per_front);
    json.member("seconds_per_flop", c.per_flop);
    json.member("seconds_per_byte", c.per_byte);
    json.member("median_error", c.median_error);
    json.end_object();
  }
  json.end_array();
  json.key("alternatives");
  json.begin_array();
  for (const records::Alternative& a : p.alternatives) {
    json.begin_object();
    json.member("leaf_size", static_cast<long long>(a.leaf_size));
    json.member("depth", static_cast<long long>(a.depth));
    json.member("present", a.is_present);
    json.member("sub_domains", static_cast<long long>(a.num_subdomains));
    json.member("leaves", static_cast<long long>(a.num_leaves));
    json.member("levels", static_cast<long long>(a.num_levels));
    json.member("flops", a.flops);
    json.member("predicted_1_thread", a.predicted);
    json.member("predicted", a.predicted_threads);
    json.end_object();
  }
  json.end_array();
}

void append_event(std::string& text, const records::ProfileEvent& e, int thread) {
  text += ",\n{\"name\":\"";
  text += e.work;
  text += "\",\"cat\":\"";
  text += e.thread < 0 ? "step" : e.visit >= 0 ? "visit" : "chunk";
  text += "\",\"ph\":\"X\",\"pid\":1,\"tid\":" + std::to_string(thread) + ",\"ts\":";
  append_rounded(text, 1e6 * e.begin, 12);
  text += ",\"dur\":";
  append_rounded(text, 1e6 * e.seconds, 6);
  text += ",\"args\":{\"";
  text += e.visit >= 0 ? "visit" : e.thread < 0 ? "number" : "first";
  text += "\":" + std::to_string(e.visit >= 0 ? e.visit : e.item) + "}}";
}

}  // namespace

std::string profile_text(const records::Profile& p, std::string_view version) {
  JsonText json;
  json.begin_object();
  json.member("scene", std::string_view(p.scene));
  json.member("title", std::string_view(p.title));
  json.member("version", version);
  json.member("cut", std::string_view(p.cut));
  json.member("form", std::string_view(p.form));
  json.member("trouble", std::string_view(p.trouble));
  write_run(json, p);
  write_speed(json, p);
  json.key("memory");
  json.begin_object();
  json.member("solver_bytes", static_cast<long long>(p.solver_bytes));
  json.member("factor_bytes", static_cast<long long>(p.factor_bytes));
  json.member("element_bytes", static_cast<long long>(p.element_bytes));
  json.member("peak_bytes", static_cast<long long>(p.peak_bytes));
  json.end_object();
  json.member("visits", static_cast<long long>(p.num_visits));
  json.member("sub_domains_in_lanes", static_cast<long long>(p.num_in_lanes));
  json.member("widest_interface_with_condition", static_cast<long long>(p.widest_condition));
  json.key("levels");
  json.begin_array();
  for (const records::LevelProfile& l : p.levels) write_level(json, l);
  json.end_array();
  write_alternatives(json, p);
  json.key("sub_domains");
  json.begin_array();
  for (const records::SubdomainProfile& s : p.subdomains) write_subdomain(json, s);
  json.end_array();
  json.end_object();
  return json.text();
}

std::string trace_text(const records::Profile& p) {
  std::string text = "{\"displayTimeUnit\":\"ms\",\"otherData\":{\"scene\":" + json_string(p.scene) +
                     ",\"events_left_out\":" + std::to_string(p.events_left_out) +
                     "},\"traceEvents\":[\n{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":1,\"args\":{\"name\":" +
                     json_string("bough " + p.scene) + "}}";
  const auto num_threads = static_cast<int>(p.thread_busy.size());
  const auto name_thread = [&text](int id, const std::string& name) {
    text += ",\n{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":" + std::to_string(id) +
            ",\"args\":{\"name\":" + json_string(name) + "}}";
  };
  name_thread(0, "steps");
  for (int t = 0; t < num_threads; ++t) name_thread(t + 1, "thread " + std::to_string(t));
  for (const records::ProfileEvent& e : p.events) append_event(text, e, e.thread + 1);
  return text + "\n]}\n";
}

}  // namespace bough::io
