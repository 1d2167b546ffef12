#include "bough/plan/history_header.hpp"

#include "bough/scene/components.hpp"

namespace bough::plan {

records::HistoryHeader make_header(const Plan& plan) {
  records::HistoryHeader header;
  header.runs_over_load = !plan.is_dynamic;
  for (const SensorPlan& s : plan.sensors) {
    const std::string& part = !s.sensor.joint.empty()  ? s.sensor.joint
                              : !s.sensor.beam.empty() ? s.sensor.beam
                                                       : s.sensor.at.to;
    for (std::size_t k = 0; k < s.components.size(); ++k) {
      const std::string& c = s.components[k];
      header.columns.push_back(c.empty() ? s.sensor.name : s.sensor.name + "." + c);
      header.about.push_back(
          {s.signal < 0 ? scene::unit_of(s.sensor, k) : s.signal_unit, scene::to_string(s.sensor.kind), part});
    }
  }
  return header;
}

}  // namespace bough::plan
