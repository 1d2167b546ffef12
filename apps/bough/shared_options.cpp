#include "shared_options.hpp"

#include "bough/io/number_text.hpp"
#include "bough/scene/components.hpp"
#include "memory_limit.hpp"

namespace bough::app {

CLI::Validator between(double low, double high) {
  const auto number = [](double x) { return io::rounded_text(x, 6); };
  const std::string range = number(low) + " to " + number(high);
  return {[=](const std::string& text) {
            double x = 0.0;
            const bool good = io::read_number(text, x) && x >= low && x <= high;
            return good ? std::string() : "'" + text + "' is not a number from " + range;
          },
          range};
}

void add_overrides(CLI::App& verb, std::vector<std::string>& overrides) {
  verb.add_option("--set", overrides, "Replace a value of the scene; may be given several times")
      ->type_name("/POINTER=VALUE")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_without(CLI::App& verb, std::vector<std::string>& overrides) {
  verb.add_option_function<std::vector<std::string>>(
          "--without",
          [&overrides](const std::vector<std::string>& names) {
            std::string list;
            for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
            overrides.push_back("/without=[" + list + "]");
          },
          "Do not take this decision of the plan (see bough plan); may be given several times")
      ->type_name("DECISION")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(CLI::IsMember(scene::names_in_without()));
}

void add_errors(CLI::App& verb, std::vector<std::string>& overrides) {
  verb.add_option_function<std::string>(
          "--errors",
          [&overrides](const std::string& asked) {
            for (const std::string kind : {"time", "mesh"})
              overrides.push_back("/analysis/errors/" + kind + (asked == kind || asked.empty() ? "=true" : "=false"));
          },
          "Measure errors of all results by runs beside this one: with longer steps, with other numbers of elements, "
          "or both (default)")
      ->expected(0, 1)
      ->type_name("[time|mesh]")
      ->check([](const std::string& text) {
        return text == "time" || text == "mesh" ? std::string() : "'" + text + "' is neither time nor mesh";
      });
  verb.add_option_function<double>(
          "--accuracy",
          [&overrides](double asked) { overrides.push_back("/analysis/accuracy=" + io::rounded_text(asked, 17)); },
          "Find steps and numbers of elements with which the errors of all sensors, relative to their ranges, are "
          "below "
          "this")
      ->type_name("SHARE")
      ->check(between(1e-12, 0.5));
}

void add_memory_limit(CLI::App& verb, double& bytes, const std::string& what) {
  verb.add_option_function<std::string>(
          "--memory-limit", [&bytes](const std::string& text) { (void)read_memory_size(text, bytes); },
          "Most memory that " + what + " may take, as 512M or 8G (default: what is available)")
      ->type_name("SIZE")
      ->check([](const std::string& text) {
        double size = 0.0;
        return read_memory_size(text, size) ? std::string() : "'" + text + "' is not a size in bytes, as 512M or 8G";
      });
}

void add_threads(CLI::App& verb, int& threads, const std::string& what) {
  verb.add_option("--threads", threads, what + " (default: as many as the machine has)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
}

CLI::Option* add_replace(CLI::App& verb, bool& replace) {
  return verb.add_flag("--replace", replace, "Replace what the directory holds of another verb, scene or batch");
}

CLI::App& add_verb(CLI::App& app, const std::string& name, const std::string& what, const std::string& examples) {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->footer("Examples:\n" + examples);
  return *verb;
}

}  // namespace bough::app
