// A line goes over the plane from left to right, upwards at each x, as Hertel and Mehlhorn (1985) let it. It
// stops at each point where there are corners. Of the edges that it crosses those between inside and outside
// are kept in order from the bottom up; between two neighbours with inside between them there is a chain, the
// border to what has been cut already. A chain bulges to the right (no two neighbours on it and a point to
// the right form a triangle that could be cut off), so that the last point that was added is its rightmost.
#include "scene/sweep_polygon.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "scene/orientation.h"

namespace coppice {
namespace {

using Point = std::uint32_t;  // a place, numbered in the order in which the line comes to it
constexpr std::uint32_t NONE = std::numeric_limits<std::uint32_t>::max();

// An edge or a part of one, from left to right.
struct Segment {
  Point from, to;
};

// The part of the plane between a segment and the next one above.
struct Interval {
  int winding = 0;                              // of the outline around it; 0: outside
  std::uint32_t bottom = 0, last = 0, top = 0;  // of its chain, where it is inside
};

class Sweep {
 public:
  Sweep(std::span<const glm::vec2> outline, std::vector<glm::uvec3>& triangles)
      : outline_(outline), triangles_(triangles), active_(Below{this}) {
    find_points();
    find_edges();
  }

  bool run() {
    for (Point p = 0; p < corner_at_.size(); ++p) {
      if (!pass(p)) return false;
    }
    return true;
  }

 private:
  struct Below {  // the order of segments that the line crosses, and of points on the line among them
    using is_transparent = void;
    const Sweep* sweep;
    bool operator()(Segment a, Segment b) const {
      if (a.from == b.from) return sweep->turn(a.from, a.to, b.to) > 0;
      return a.from < b.from ? (*this)(a, b.from) : (*this)(a.from, b);
    }
    bool operator()(Segment a, Point p) const { return sweep->turn(a.from, a.to, p) > 0; }
    bool operator()(Point p, Segment b) const { return sweep->turn(b.from, b.to, p) < 0; }
  };
  using Active = std::map<Segment, Interval, Below>;

  // A way that an edge goes on from a point.
  struct Way {
    Point to;
    int weight;          // 1 where the outline goes to the right, so that it winds once more above, else -1
    std::uint32_t next;  // of the same point
  };

  struct Link {
    Point point;
    std::uint32_t down, up;
  };

  int turn(Point a, Point b, Point c) const {
    return orientation(outline_[corner_at_[a]], outline_[corner_at_[b]], outline_[corner_at_[c]]);
  }

  void find_points() {
    std::vector<std::uint32_t> order(outline_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [this](std::uint32_t i) { return std::tuple(outline_[i].x, outline_[i].y); };
    std::ranges::sort(order, [&](auto a, auto b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    point_of_.resize(outline_.size());
    for (const std::uint32_t i : order) {
      if (corner_at_.empty() || key(corner_at_.back()) != key(i)) corner_at_.push_back(i);
      point_of_[i] = static_cast<Point>(corner_at_.size() - 1);
    }
  }

  void find_edges() {
    first_way_.assign(corner_at_.size(), NONE);
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const Point a = point_of_[i], b = point_of_[i + 1 < outline_.size() ? i + 1 : 0];
      if (a != b) add_way(std::min(a, b), std::max(a, b), a < b ? 1 : -1);
    }
  }

  void add_way(Point from, Point to, int weight) {
    ways_.push_back({to, weight, first_way_[from]});
    first_way_[from] = static_cast<std::uint32_t>(ways_.size() - 1);
  }

  // The ways from p from the bottom up, one a direction: as far as the nearest point on it, from where the
  // longer ones go on. Ways there and back are none.
  void gather_ways(Point p) {
    leaving_.clear();
    for (std::uint32_t i = first_way_[p]; i != NONE; i = ways_[i].next) leaving_.push_back(ways_[i]);
    std::ranges::sort(leaving_, [&](const Way& a, const Way& b) {
      const int side = turn(p, a.to, b.to);
      return side != 0 ? side > 0 : a.to < b.to;
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < leaving_.size();) {
      Way way = leaving_[i];
      for (++i; i < leaving_.size() && turn(p, way.to, leaving_[i].to) == 0; ++i) {
        way.weight += leaving_[i].weight;
        if (leaving_[i].to != way.to) add_way(way.to, leaving_[i].to, leaving_[i].weight);
      }
      if (way.weight != 0) leaving_[kept++] = way;
    }
    leaving_.resize(kept);
  }

  std::uint32_t add_link(Point p) {
    links_.push_back({p, NONE, NONE});
    return static_cast<std::uint32_t>(links_.size() - 1);
  }

  void join(std::uint32_t lower, std::uint32_t upper) {
    links_[lower].up = upper;
    links_[upper].down = lower;
  }

  void cut(Point lower, Point right, Point upper, int winding) {
    if (turn(lower, right, upper) == 0) return;
    const std::uint32_t a = corner_at_[lower], b = corner_at_[right], c = corner_at_[upper];
    triangles_.emplace_back(a, winding > 0 ? b : c, winding > 0 ? c : b);
  }

  // Cuts off what p sees of the chain from its last point upwards: all of it where the edge above ends in p.
  // The uppermost link that was reached.
  std::uint32_t cut_upwards(const Interval& inside, Point p, bool all) {
    std::uint32_t link = inside.last;
    while (link != inside.top) {
      const std::uint32_t upper = links_[link].up;
      if (!all && turn(links_[link].point, p, links_[upper].point) <= 0) break;
      cut(links_[link].point, p, links_[upper].point, inside.winding);
      link = upper;
    }
    return link;
  }

  std::uint32_t cut_downwards(const Interval& inside, Point p, bool all) {
    std::uint32_t link = inside.last;
    while (link != inside.bottom) {
      const std::uint32_t lower = links_[link].down;
      if (!all && turn(links_[lower].point, p, links_[link].point) <= 0) break;
      cut(links_[lower].point, p, links_[link].point, inside.winding);
      link = lower;
    }
    return link;
  }

  // The chain below p, which ends in a link of p.
  Interval end_at(const Interval& below, std::uint32_t link, Point p, bool edge_ends) {
    if (edge_ends) cut_upwards(below, p, true);
    const std::uint32_t lower = cut_downwards(below, p, false);
    join(lower, link);
    return {below.winding, below.bottom, link, link};
  }

  Interval begin_at(const Interval& above, std::uint32_t link, Point p, bool edge_ends) {
    if (edge_ends) cut_downwards(above, p, true);
    const std::uint32_t upper = cut_upwards(above, p, false);
    join(link, upper);
    return {above.winding, link, link, above.top};
  }

  // Makes two chains of one, which both have its last point.
  void part(const Interval& below, Interval& above) {
    const std::uint32_t copy = add_link(links_[below.last].point);
    if (below.last == below.top) {
      above.top = copy;
    } else {
      join(copy, links_[below.last].up);
    }
    above.bottom = above.last = copy;
  }

  // Lets the line pass p.
  bool pass(Point p) {
    const auto [first, end] = active_.equal_range(p);  // the segments that end in p or go through it
    for (auto i = first; i != end; ++i) {
      if (i->first.to != p) add_way(p, i->first.to, i->second.winding - winding_below(i));
    }
    gather_ways(p);
    const bool edges_end = first != end;
    if (!edges_end && leaving_.empty()) return true;

    const auto predecessor = first == active_.begin() ? active_.end() : std::prev(first);
    Interval nothing;
    Interval& below = predecessor == active_.end() ? nothing : predecessor->second;
    Interval above = below;
    for (auto i = first; i != end; ++i) {
      above = i->second;
      if (above.winding != 0 && std::next(i) != end) {
        cut_upwards(above, p, true);
        cut_downwards(above, p, true);
      }
    }
    active_.erase(first, end);

    const bool joined = leaving_.empty();
    const std::uint32_t link = add_link(p);
    const std::uint32_t upper_link = joined ? link : add_link(p);
    if (!edges_end && below.winding != 0) part(below, above);
    if (above.winding != 0) above = begin_at(above, upper_link, p, edges_end);
    if (below.winding != 0) {
      const std::uint32_t top = joined ? above.top : link;
      below = end_at(below, link, p, edges_end);
      below.top = top;
    }
    return joined ? do_not_cross(predecessor, end) : leave(p, below.winding, above, predecessor, end);
  }

  int winding_below(Active::iterator i) { return i == active_.begin() ? 0 : std::prev(i)->second.winding; }

  // Adds the segments that leave p, the uppermost of them below the interval `above`.
  bool leave(Point p, int winding, const Interval& above, Active::iterator predecessor,
             Active::iterator successor) {
    Active::iterator added = predecessor;
    for (std::size_t i = 0; i < leaving_.size(); ++i) {
      winding += leaving_[i].weight;
      Interval interval{winding, NONE, NONE, NONE};
      if (i + 1 == leaving_.size()) {
        if (winding != above.winding) return false;
        interval = above;
      } else if (winding != 0) {
        const std::uint32_t link = add_link(p);
        interval = {winding, link, link, link};
      }
      const std::size_t count = active_.size();
      added = active_.emplace_hint(successor, Segment{p, leaving_[i].to}, interval);
      if (active_.size() == count) return false;
      if (i == 0 && !do_not_cross(predecessor, added)) return false;
    }
    return do_not_cross(added, successor);
  }

  // Whether two neighbours are apart but for their ends. What only touches is found when the line gets there.
  bool do_not_cross(Active::iterator lower, Active::iterator upper) const {
    if (lower == active_.end() || upper == active_.end()) return true;
    const Segment a = lower->first, b = upper->first;
    return turn(a.from, a.to, b.from) * turn(a.from, a.to, b.to) >= 0 ||
           turn(b.from, b.to, a.from) * turn(b.from, b.to, a.to) >= 0;
  }

  std::span<const glm::vec2> outline_;
  std::vector<glm::uvec3>& triangles_;
  std::vector<std::uint32_t> corner_at_;  // one of the corners at each point
  std::vector<Point> point_of_;           // of each corner
  std::vector<Way> ways_;
  std::vector<std::uint32_t> first_way_;  // of each point
  std::vector<Way> leaving_;              // reused
  std::vector<Link> links_;
  Active active_;
};

}  // namespace

bool sweep_polygon(std::span<const glm::vec2> outline, std::vector<glm::uvec3>& triangles) {
  return Sweep(outline, triangles).run();
}

}  // namespace coppice
