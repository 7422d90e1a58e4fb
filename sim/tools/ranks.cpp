#include "leeway/sim/tools/ranks.hpp"

#include <cstdlib>
#include <initializer_list>

#ifdef LEEWAY_HAS_MPI
#include <mpi.h>

#include <chrono>
#include <thread>
#endif

namespace leeway::sim {
namespace {

#ifdef LEEWAY_HAS_MPI
constexpr bool kHasMpi = true;
#else
constexpr bool kHasMpi = false;
#endif

/// What Open MPI, PMIx (srun) and PMI (MPICH, srun) tell the processes that they start.
const char* launcher_variable(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const char* value = std::getenv(name)) return value;
  }
  return nullptr;
}

const char* launched_rank() {
  return launcher_variable({"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"});
}

/// Processes that each took themselves for the only one would all do the whole work.
void refuse_strangers(int count) {
  const char* launched = launcher_variable({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"});
  if (launched == nullptr || std::atoi(launched) == count) return;
  throw Error("started as one of " + std::string(launched) + " processes, but " +
              (kHasMpi ? "the launcher belongs to another MPI than the one built with"
                       : "built without MPI: install libopenmpi-dev and build again"));
}

}  // namespace

bool Ranks::launched_first() {
  const char* rank = launched_rank();
  return rank == nullptr || std::string(rank) == "0";
}

#ifdef LEEWAY_HAS_MPI

namespace {

enum Tag : int { kBytes, kFailure };

void send(const std::string& bytes, int to, Tag tag) {
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD);
}

struct Message {
  std::string bytes;
  int tag;
};

Message receive(MPI_Status status) {
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  Message message{std::string(static_cast<std::size_t>(size), '\0'), status.MPI_TAG};
  MPI_Recv(message.bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return message;
}

/// Waits without taking the processor from those that compute.
Message next_message() {
  for (;;) {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (there != 0) return receive(status);
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
}

/// A failure travels as its exit code, a space and its text.
[[noreturn]] void throw_failure(const std::string& bytes) {
  const std::size_t space = bytes.find(' ');
  throw RankFailure(bytes.substr(space + 1), std::atoi(bytes.c_str()));
}

}  // namespace

Ranks::Ranks() {
  if (launched_rank() == nullptr) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  has_started_mpi_ = true;
  refuse_strangers(count_);
}

Ranks::~Ranks() {
  if (has_started_mpi_) MPI_Finalize();
}

std::string Ranks::from_first(const std::string& bytes) const {
  if (!is_first()) return next_message().bytes;
  for (int other = 1; other < count_; ++other) send(bytes, other, kBytes);
  return bytes;
}

void Ranks::to_first(const std::string& bytes,
                     const std::function<void(const std::string&)>& f) const {
  if (!is_first()) return send(bytes, 0, kBytes);
  for (int other = 1; other < count_; ++other) {
    const Message message = next_message();
    if (message.tag == kFailure) throw_failure(message.bytes);
    f(message.bytes);
  }
}

void Ranks::check_others() const {
  if (!is_first() || count_ == 1) return;
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kFailure, MPI_COMM_WORLD, &there, &status);
  if (there != 0) throw_failure(receive(status).bytes);
}

void Ranks::stop(const std::string& message, int exit_code) const {
  if (!is_first()) {
    send(std::to_string(exit_code) + " " + message, 0, kFailure);
    // What the first still sends must not keep it from hearing; it will end this process.
    for (;;) next_message();
  }
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::abort();
}

#else

Ranks::Ranks() { refuse_strangers(count_); }

Ranks::~Ranks() = default;

std::string Ranks::from_first(const std::string& bytes) const { return bytes; }
void Ranks::to_first(const std::string&, const std::function<void(const std::string&)>&) const {}
void Ranks::check_others() const {}
void Ranks::stop(const std::string&, int) const { std::abort(); }

#endif

}  // namespace leeway::sim
