/// @file
/// The processes that share one piece of work: MPI ranks, or this process alone.
#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <type_traits>

#include "leeway/earth/error.hpp"

namespace leeway::sim {

/// Error of another rank, which cannot go on.
struct RankFailure : Error {
  RankFailure(const std::string& message, int code) : Error(message), exit_code(code) {}
  int exit_code;
};

/// The processes of one run. Rank 0 is the first: it distributes work, collects results, and alone
/// writes to the user. MPI is started only when mpirun or srun started the program. A rank that
/// fails tells the first, which stops all. Not safe to share between threads.
class Ranks {
 public:
  /// All processes that the launcher started, or this one alone without a launcher.
  /// @throws Error when a launcher started several processes and they cannot find each other.
  Ranks();

  /// This process alone, whatever started it.
  static Ranks alone() { return Ranks(Alone{}); }
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  /// Whether no launcher started this process, or started it as rank 0. Needs no MPI.
  static bool launched_first();

  int rank() const { return rank_; }
  int count() const { return count_; }
  bool is_first() const { return rank_ == 0; }

  /// The bytes of the first rank, on every rank. @param bytes  used on the first only
  std::string from_first(const std::string& bytes) const;

  /// The value of the first rank, on every rank.
  template <class Value>
  requires std::is_trivially_copyable_v<Value> Value from_first(const Value& value)
  const {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    bytes = from_first(bytes);
    Value first;
    std::memcpy(&first, bytes.data(), sizeof first);
    return first;
  }

  /// Transfer of bytes from the other ranks to the first, which calls f with those of each rank, in
  /// the order of arrival.
  /// @throws RankFailure on the first when a rank has failed instead.
  void to_first(const std::string& bytes, const std::function<void(const std::string&)>& f) const;

  /// A check of the other ranks, for the first to make now and then while it works.
  /// @throws RankFailure when another rank has failed.
  void check_others() const;

  /// The end of all ranks with the exit code. The first ends them at once. Another rank tells the
  /// first, which learns of it in check_others() or to_first(). @pre count() > 1.
  [[noreturn]] void stop(const std::string& message, int exit_code) const;

 private:
  struct Alone {};
  explicit Ranks(Alone) {}

  int rank_{0};
  int count_{1};
  [[maybe_unused]] bool has_started_mpi_{false};  // unused when built without MPI
};

}  // namespace leeway::sim
