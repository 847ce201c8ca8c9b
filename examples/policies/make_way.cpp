// The policy of make_way.py in C++, over a socket, without any library.
//
//   g++ -O2 -o make_way examples/policies/make_way.cpp && ./make_way 5555
//   esplanade evaluate crowd.csv --policy tcp://127.0.0.1:5555/MakeWay --processes 1

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

constexpr double kReachM = 2.0;
constexpr double kPush = 0.6;

// The two numbers after a key, such as "position":[1.5,-2.0], from a place in the line on.
struct Pair {
  double x = 0.0, y = 0.0;
  size_t end = std::string::npos;
};

Pair pair_after(const std::string& line, const std::string& key, size_t from = 0) {
  Pair found;
  const size_t at = line.find("\"" + key + "\":[", from);
  if (at == std::string::npos) return found;
  char* rest = nullptr;
  found.x = std::strtod(line.c_str() + at + key.size() + 4, &rest);
  found.y = std::strtod(rest + 1, &rest);
  found.end = rest - line.c_str();
  return found;
}

std::string answer(const std::string& line, double& speed) {
  if (line.find("\"ask\":\"reset\"") != std::string::npos) {
    const std::string key = "\"preferred_speed\":";
    speed = std::strtod(line.c_str() + line.find(key) + key.size(), nullptr);
    return "{\"ready\":true}\n";
  }
  if (line.find("\"ask\":\"explain\"") != std::string::npos) return "{}\n";
  if (line.find("\"ask\":\"velocity\"") == std::string::npos) return "{\"ready\":true}\n";
  const Pair here = pair_after(line, "position"), waypoint = pair_after(line, "waypoint");
  const double ahead = std::max(1e-9, std::hypot(waypoint.x - here.x, waypoint.y - here.y));
  double vx = speed * (waypoint.x - here.x) / ahead, vy = speed * (waypoint.y - here.y) / ahead;
  const size_t people = line.find("\"people\":");
  for (Pair person = pair_after(line, "position", people); person.end != std::string::npos;
       person = pair_after(line, "position", person.end)) {
    const double dx = here.x - person.x, dy = here.y - person.y;
    const double distance = std::max(0.1, std::hypot(dx, dy));
    if (distance >= kReachM) continue;
    vx += kPush * dx / distance * (kReachM - distance);
    vy += kPush * dy / distance * (kReachM - distance);
  }
  char text[96];
  std::snprintf(text, sizeof text, "{\"velocity\":[%.17g,%.17g]}\n", vx, vy);
  return text;
}

// Answer one evaluation until it hangs up.
void serve(int line) {
  double speed = 1.3;
  std::string read;
  char part[65536];
  for (ssize_t got; (got = recv(line, part, sizeof part, 0)) > 0;) {
    read.append(part, got);
    for (size_t end; (end = read.find('\n')) != std::string::npos; read.erase(0, end + 1)) {
      const std::string reply = answer(read.substr(0, end), speed);
      if (send(line, reply.data(), reply.size(), MSG_NOSIGNAL) < 0) return;
    }
  }
}

int main(int count, char** words) {
  const int server = socket(AF_INET, SOCK_STREAM, 0), on = 1;
  setsockopt(server, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(count > 1 ? std::atoi(words[1]) : 5555);
  socklen_t size = sizeof address;
  if (bind(server, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(server, 8) != 0) {
    std::perror("cannot listen");
    return 1;
  }
  getsockname(server, reinterpret_cast<sockaddr*>(&address), &size);
  std::printf("listening on %d\n", ntohs(address.sin_port));
  std::fflush(stdout);
  for (int line; (line = accept(server, nullptr, nullptr)) >= 0; close(line)) {
    setsockopt(line, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    serve(line);
  }
}
