#include <cstring>
#include <string_view>
#include <type_traits>

#include "leeway/sim/replay/log_study.hpp"

namespace leeway::sim {
namespace {

template <class Items>
concept Sequence = requires(Items items) {
  items.data();
  items.size();
};

/// The fields of a study one after the other, each as it lies in memory.
struct StudyWriter {
  std::string bytes{};

  void operator()(const auto& value) {
    if constexpr (Sequence<decltype(value)>) {
      (*this)(value.size());
      bytes.append(reinterpret_cast<const char*>(value.data()), value.size() * sizeof value[0]);
    } else {
      static_assert(std::is_trivially_copyable_v<std::decay_t<decltype(value)>>);
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
};

struct StudyReader {
  std::string_view rest;

  void take(void* to, std::size_t size) {
    if (size > 0) std::memcpy(to, rest.data(), size);
    rest.remove_prefix(size);
  }

  void operator()(auto& value) {
    if constexpr (Sequence<decltype(value)>) {
      std::size_t size = 0;
      take(&size, sizeof size);
      value.resize(size);
      take(value.data(), size * sizeof value[0]);
    } else {
      take(&value, sizeof value);
    }
  }
};

void visit(auto& study, auto& f) {
  f(study.has_solution);
  f(study.against);
  f(study.first_s);
  f(study.settled_s);
  f(study.last_s);
  f(study.receiver);
  f(study.imu_sigma_scale);
  f(study.outages);
  f(study.errors);
  f(study.expected);
  f(study.not_expected);
}

}  // namespace

std::string bytes_of(const LogStudy& study) {
  StudyWriter writer;
  visit(study, writer);
  return writer.bytes;
}

LogStudy log_study_of(const std::string& bytes) {
  LogStudy study;
  StudyReader reader{bytes};
  visit(study, reader);
  return study;
}

}  // namespace leeway::sim
