"""The sketches of docs/tour.md: each function returns the text of an SVG file. The same code gives the same text."""
import math

import svg

STATIC, RESTING, AWAKE = "#8d96a3", "#3f7fd9", "#ee7b30"  # as in pictures of `fase draw`
RAY, NODE = svg.VERMILION, svg.NAVY
SIZE = 13


class Sketch(svg.Canvas):
    """A sheet on which shapes are drawn in world units: view() says where the origin is and how long a unit is."""

    def view(self, left, top, scale, origin=(0, 0), up=False):
        self.place = lambda x, y: (left + (x - origin[0]) * scale, top + (y - origin[1]) * scale * (-1 if up else 1))
        self.scale = scale
        return self

    def label(self, x, y, text, anchor="start", colour=svg.INK, dx=0, dy=0, halo=True):
        px, py = self.place(x, y)
        self.text(px + dx, py + dy, text, anchor=anchor, colour=colour, size=SIZE, halo=halo)

    def polygon(self, points, fill="none", stroke=svg.INK, opacity=0.3, width=1.5, dashed=False):
        text = " ".join("{:.1f},{:.1f}".format(*self.place(*p)) for p in points)
        dashes = ' stroke-dasharray="5 4"' if dashed else ""
        self.parts.append(f'<polygon points="{text}" fill="{fill}" fill-opacity="{opacity}" stroke="{stroke}" stroke-width="{width}"{dashes}/>')

    def box(self, x0, y0, x1, y1, **style):
        self.polygon([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], **style)

    def circle(self, x, y, radius, fill="none", stroke=svg.INK, opacity=0.3, width=1.5, dashed=False):
        px, py = self.place(x, y)
        dashes = ' stroke-dasharray="5 4"' if dashed else ""
        self.parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{radius * self.scale:.1f}" fill="{fill}" fill-opacity="{opacity}" '
                          f'stroke="{stroke}" stroke-width="{width}"{dashes}/>')

    def point(self, x, y, colour=svg.INK, radius=4):
        self.dot(*self.place(x, y), colour, radius)

    def path(self, points, colour, width=2, dashed=False):
        text = " ".join("{:.1f},{:.1f}".format(*self.place(*p)) for p in points)
        dashes = ' stroke-dasharray="6 4"' if dashed else ""
        self.parts.append(f'<polyline points="{text}" fill="none" stroke="{colour}" stroke-width="{width}"{dashes}/>')

    def arrow(self, x0, y0, x1, y1, colour, width=2.5, dashed=False):
        (ax, ay), (bx, by) = self.place(x0, y0), self.place(x1, y1)
        angle, head = math.atan2(by - ay, bx - ax), 10
        ends = [(bx - head * math.cos(angle + turn), by - head * math.sin(angle + turn)) for turn in (-0.4, 0.4)]
        dashes = ' stroke-dasharray="6 4"' if dashed else ""
        self.parts.append(f'<line x1="{ax:.1f}" y1="{ay:.1f}" x2="{bx - 6 * math.cos(angle):.1f}" y2="{by - 6 * math.sin(angle):.1f}" '
                          f'stroke="{colour}" stroke-width="{width}"{dashes}/>')
        corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in [(bx, by), *ends])
        self.parts.append(f'<polygon points="{corners}" fill="{colour}"/>')

    def note(self, x, y, *lines, anchor="start", colour=svg.INK):
        """Lines of text at pixels of the sheet."""
        for i, line in enumerate(lines):
            self.text(x, y + 18 * i, line, anchor=anchor, colour=colour, size=SIZE)


def turned(x, y, half_x, half_y, angle):
    """The corners of a rectangle that is turned about its middle."""
    c, s = math.cos(angle), math.sin(angle)
    return [(x + c * a - s * b, y + s * a + c * b)
            for a, b in ((-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y))]


def index():
    sketch = Sketch(360, "An index of three boxes", "From above; a square of the grid is 1 m wide.").view(60, 70, 38)
    for i in range(14):
        sketch.path([(i, 0), (i, 7)], svg.GRID, width=1)
    for i in range(8):
        sketch.path([(0, i), (13, i)], svg.GRID, width=1)
    for name, (x0, z0, x1, z1) in {"shed": (0, 0, 4, 5), "bench": (3, 4, 6, 6), "ball": (7, 1, 8, 2)}.items():
        sketch.box(x0, z0, x1, z1, fill=STATIC if name != "ball" else AWAKE, stroke=STATIC if name != "ball" else AWAKE)
        sketch.label((x0 + x1) / 2 + (name == "bench") * 0.5, z0, name, anchor="middle", dy=-6 if name == "ball" else 18, halo=False)
    sketch.box(3, 4, 4, 5, fill=svg.PURPLE, stroke=svg.PURPLE, opacity=0.6)
    sketch.label(3.1, 4.5, "a pair", anchor="end", dx=-8, dy=4)
    sketch.arrow(12, 1.5, 8, 1.5, RAY)
    sketch.label(10, 1.5, "the ray: 4 m to its hit", anchor="middle", dy=-8)
    sketch.box(5, 5, 6, 6, fill=AWAKE, stroke=AWAKE, dashed=True)
    sketch.arrow(7.3, 2.1, 6, 4.8, svg.GREY, width=1.5, dashed=True)
    sketch.label(6.9, 3.5, "move() to the end of the bench", dx=4)
    sketch.point(5.5, 5.5)
    sketch.label(6, 5.5, "at(): two boxes contain this point", dx=10, dy=4)
    return sketch.finish()


def two_phases():
    sketch = Sketch(290, "Broad phase and narrow phase", "The broad phase compares boxes, the narrow phase the shapes in them.")
    for left, shift, title, verdict in ((20, 3.0, "boxes apart", "broad phase: no pair"),
                                        (290, 2.1, "boxes overlap, shapes do not", "a pair; narrow phase: no contact"),
                                        (555, 1.3, "shapes overlap", "a pair; narrow phase: a contact")):
        sketch.view(left + 70, 175, 42)
        angle = 0.75
        half = abs(math.cos(angle)) * 1.2 + abs(math.sin(angle)) * 0.4, abs(math.sin(angle)) * 1.2 + abs(math.cos(angle)) * 0.4
        sketch.polygon(turned(0, 0, 1.2, 0.4, angle), fill=svg.BLUE, stroke=svg.BLUE)
        sketch.box(-half[0], -half[1], half[0], half[1], stroke=svg.GREY, dashed=True)
        x, z, radius = shift * 0.85, -0.35 - 0.3 * shift / 2, 0.75
        sketch.circle(x, z, radius, fill=AWAKE, stroke=AWAKE)
        sketch.box(x - radius, z - radius, x + radius, z + radius, stroke=svg.GREY, dashed=True)
        sketch.note(left, 86, title)
        sketch.note(left, 264, verdict)
    return sketch.finish()


def planes():
    """A BSP tree of six walls and a crate: the plan on the left, the tree on the right."""
    sketch = Sketch(425, "A BSP tree of six walls and a crate",
                    "From above. Each plane lies on a face of a wall and divides what is left of the level.").view(30, 96, 25)
    boxes = {"a": (0, 5, 8, 5.6), "b": (9.6, 5, 14, 5.6), "c": (4, 0, 4.6, 3), "d": (10, 0, 10.6, 5), "e": (3, 5.6, 3.6, 10), "f": (9, 5.6, 9.6, 10),
             "g": (3.9, 3.4, 5.3, 4.6)}
    for name, (x0, z0, x1, z1) in boxes.items():
        sketch.box(x0, z0, x1, z1, fill=AWAKE if name == "g" else STATIC, stroke=AWAKE if name == "g" else STATIC, opacity=0.5)
        sketch.label((x0 + x1) / 2, (z0 + z1) / 2, name, anchor="middle", dy=4, halo=False)
    sketch.path([(-0.7, 5), (15.2, 5)], svg.VERMILION)
    sketch.label(15.3, 5, "1", colour=svg.VERMILION, dy=4)
    sketch.path([(4.6, -0.6), (4.6, 5)], svg.GREEN)
    sketch.label(4.6, -0.6, "2", colour=svg.GREEN, anchor="middle", dy=-5)
    sketch.path([(-0.7, 5.6), (15.2, 5.6)], svg.PURPLE)
    sketch.label(15.3, 5.6, "3", colour=svg.PURPLE, dy=9)
    sketch.path([(3.6, 5.6), (3.6, 10.6)], svg.BLUE)
    sketch.label(3.6, 10.6, "4", colour=svg.BLUE, anchor="middle", dy=16)
    sketch.view(466, 100, 1)
    nodes = {"1": (150, 0, svg.VERMILION), "2": (60, 80, svg.GREEN), "3": (225, 80, svg.PURPLE), "4": (265, 160, svg.BLUE)}
    leaves = {"c": (10, 160), "g": (60, 160), "d": (110, 160), "a b": (185, 160), "e": (230, 240), "f": (300, 240)}
    edges = [("1", "2"), ("1", "3"), ("2", "c"), ("2", "g"), ("2", "d"), ("3", "a b"), ("3", "4"), ("4", "e"), ("4", "f")]
    for parent, child in edges:
        sketch.path([nodes[parent][:2], (nodes.get(child) or leaves[child])[:2]], svg.GREY, width=1.2)
    for name, (x, y, colour) in nodes.items():
        sketch.circle(x, y, 15, fill="#ffffff", stroke=colour, opacity=1, width=2.5)
        sketch.label(x, y, name, anchor="middle", dy=5, halo=False)
    for name, (x, y) in leaves.items():
        sketch.box(x - 20, y - 14, x + 20, y + 14, fill="#e6e9ed", stroke=AWAKE if name == "g" else STATIC, opacity=1)
        sketch.label(x, y, name, anchor="middle", dy=5, halo=False)
    sketch.note(30, 390, "Circles are planes, boxes are leaves. The left child is in front of the plane (above it or left of it in the plan), the",
                "right child behind; between them is what straddles the plane. Plane 2 ends at plane 1.")
    return sketch.finish()


def leaves():
    """The first three lines that example_05_leaves prints, and how leaves store their boxes."""
    sketch = Sketch(430, "The leaves of a quadtree",
                    "Capacity 2, a root of 64 m; seen from above. Below: the arrays of the last tree, and (first, count) of each leaf.")
    boxes = {"0": (10, 10), "1": (50, 12), "2": (20, 44), "3": (32, 12)}
    for left, count, title in ((20, 2, "two boxes: one leaf"), (285, 3, "a third: the root splits"), (550, 4, "one across the border")):
        sketch.view(left, 92, 3.4)
        if count > 2:
            for x, z in ((0, 0), (32, 0), (0, 32)):
                sketch.box(x, z, x + 32, z + 32, fill=svg.SKY, stroke=NODE, opacity=0.12)
            sketch.box(32, 32, 64, 64, stroke=svg.GREY, width=1, dashed=True)
            sketch.label(48, 48, "not created", anchor="middle", colour=svg.GREY, dy=4)
        else:
            sketch.box(0, 0, 64, 64, fill=svg.SKY, stroke=NODE, opacity=0.12)
        for name, (x, z) in list(boxes.items())[:count]:
            sketch.box(x - 2.5, z - 2.5, x + 2.5, z + 2.5, fill=AWAKE, stroke=AWAKE, opacity=0.6)
            sketch.label(x, z, name, anchor="middle", dy=-12)
        sketch.note(left, 82, title)
    colours = {"upper left": svg.SKY, "upper right": svg.GREEN, "lower left": svg.ORANGE}
    for x, title, entries in ((20, "boxes", [("0", "upper left"), ("3", "upper left"), ("1", "upper right"), ("2", "lower left")]),
                              (380, "references", [("3", "upper right")])):
        sketch.note(x, 351, title)
        sketch.view(x + 80, 334, 44)
        for i, (name, leaf) in enumerate(entries):
            sketch.box(i, 0, i + 1, 0.6, fill=colours[leaf], stroke=svg.GREY, opacity=0.35)
            sketch.label(i + 0.5, 0.3, name, anchor="middle", dy=5, halo=False)
    for i, (leaf, ranges) in enumerate(zip(colours, ("boxes (0, 2)", "boxes (2, 1), references (0, 1)", "boxes (3, 1)"))):
        sketch.bar(20 + (0, 215, 540)[i], 388, 12, 11, colours[leaf])
        sketch.note(37 + (0, 215, 540)[i], 398, f"{leaf}: {ranges}")
    return sketch.finish()


def octree():
    """A cube with its eight children; the near upper right one is split again."""
    sketch = Sketch(330, "An octree", "A cube with more boxes than the capacity is split in half along all three axes.").view(150, 240, 62)

    def at(x, y, z):
        return x + 0.5 * z, -y - 0.35 * z

    def faces(x, y, z, side, **style):
        """The front, the upper and the right face of a cube."""
        for corners in (((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)), ((0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)),
                        ((1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0))):
            sketch.polygon([at(x + side * a, y + side * b, z + side * c) for a, b, c in corners], **style)

    def split(x, y, z, side, **style):
        for c in (1, 0):
            for b in (0, 1):
                for a in (0, 1):
                    faces(x + a * side / 2, y + b * side / 2, z + c * side / 2, side / 2, fill="#ffffff", opacity=1, **style)

    for left, title in ((60, "a cube: a leaf"), (310, "split: up to 8 children"), (560, "one of them split again")):
        sketch.view(left, 270, 62)
        if left == 60:
            faces(0, 0, 0, 2, fill=svg.SKY, stroke=NODE, opacity=0.12)
        else:
            split(0, 0, 0, 2, stroke=NODE)
        if left == 560:
            split(1, 1, 0, 1, stroke=svg.VERMILION)
        sketch.note(left, 82, title)
    sketch.note(20, 318, "Numbers of children have one bit per axis: 0 in the lower half, 1 in the upper half. Empty children are not created.")
    return sketch.finish()


def atlas_tree():
    """Three images on a page, and the kD-tree of its free space after each."""
    sketch = Sketch(420, "A kD-tree of free space",
                    "Each image goes into the upper left corner of a free leaf; one or two cuts separate it from the rest of the leaf.")
    images = {"A": (0, 0, 60, 50), "B": (60, 0, 30, 50), "C": (0, 50, 80, 25)}
    colours = {"A": svg.SKY, "B": svg.ORANGE, "C": svg.GREEN}
    sketch.view(30, 90, 2.6)
    sketch.box(0, 0, 100, 100)
    for name, (x, y, width, height) in images.items():
        sketch.box(x, y, x + width, y + height, fill=colours[name], stroke=colours[name], opacity=0.4)
        sketch.label(x + width / 2, y + height / 2, f"{name}: {width} x {height}", anchor="middle", dy=5, halo=False)
    for x0, y0, x1, y1, name, colour in ((0, 50, 100, 50, "1", svg.VERMILION), (60, 0, 60, 50, "2", svg.VERMILION), (90, 0, 90, 50, "3", svg.PURPLE),
                                         (0, 75, 100, 75, "4", svg.NAVY), (80, 50, 80, 75, "5", svg.NAVY)):
        sketch.path([(x0, y0), (x1, y1)], colour, width=2)
        sketch.label(x1, y1, name, dx=4 if x1 == 100 else -3, dy=4 if x1 == 100 else 14, colour=colour, anchor="start" if x1 == 100 else "end")
    for x, y, name in ((95, 25, "p"), (90, 62, "q"), (50, 88, "r")):
        sketch.label(x, y, name, anchor="middle", dy=5, colour=svg.GREY)
    sketch.view(340, 110, 1)
    nodes = {"1": (190, 0, svg.VERMILION), "2": (95, 65, svg.VERMILION), "3": (145, 130, svg.PURPLE),
             "4": (295, 65, svg.NAVY), "5": (245, 130, svg.NAVY)}
    leaves = {"A": (45, 130), "B": (110, 195), "p": (170, 195), "C": (225, 195), "q": (285, 195), "r": (345, 130)}
    for parent, child in (("1", "2"), ("1", "4"), ("2", "A"), ("2", "3"), ("3", "B"), ("3", "p"), ("4", "5"), ("4", "r"), ("5", "C"), ("5", "q")):
        sketch.path([nodes[parent][:2], (nodes.get(child) or leaves[child])[:2]], svg.GREY, width=1.2)
    for name, (x, y, colour) in nodes.items():
        sketch.circle(x, y, 14, fill="#ffffff", stroke=colour, opacity=1, width=2.5)
        sketch.label(x, y, name, anchor="middle", dy=5, halo=False)
    for name, (x, y) in leaves.items():
        colour = colours.get(name)
        sketch.box(x - 18, y - 14, x + 18, y + 14, fill="#ffffff", stroke=STATIC, opacity=1, dashed=colour is None)
        if colour:
            sketch.box(x - 18, y - 14, x + 18, y + 14, fill=colour, stroke=colour, opacity=0.4)
        sketch.label(x, y, name, anchor="middle", dy=5, halo=False)
    sketch.note(330, 350, "Circles: cuts, in the order in which they were made.", "Full boxes: leaves with an image; dashed ones: free leaves.",
                "A made 1 and 2, B made 3, C made 4 and 5.")
    return sketch.finish()


def bounce():
    sketch = Sketch(290, "An elastic collision of two ghosts of equal mass",
                    "They exchange the parts of their velocities along the line between them.")
    a, b, va, vb = (0, 0), (1.9, -0.6), (2.6, 0.2), (-0.9, 0.9)
    gap = math.hypot(b[0] - a[0], b[1] - a[1])
    n = (b[0] - a[0]) / gap, (b[1] - a[1]) / gap
    approach = (va[0] - vb[0]) * n[0] + (va[1] - vb[1]) * n[1]
    after = ((va[0] - n[0] * approach, va[1] - n[1] * approach), (vb[0] + n[0] * approach, vb[1] + n[1] * approach))
    for left, title, velocities in ((130, "before", (va, vb)), (510, "after", after)):
        sketch.view(left, 190, 42)
        sketch.path([(a[0] - 2.4 * n[0], a[1] - 2.4 * n[1]), (b[0] + 2.4 * n[0], b[1] + 2.4 * n[1])], svg.GREY, width=1, dashed=True)
        for (x, y), colour in ((a, svg.BLUE), (b, svg.VERMILION)):
            sketch.circle(x, y, gap / 2, fill=colour, stroke=colour, opacity=0.2)
        for (x, y), (vx, vy), colour in ((a, velocities[0], svg.BLUE), (b, velocities[1], svg.VERMILION)):
            sketch.arrow(x, y, x + vx, y + vy, colour)
        sketch.note(left - 100, 86, title)
    sketch.note(20, 280, "dashed: the line between the centres; arrows: velocities")
    return sketch.finish()


def players():
    """The paths of example_07_walls_and_players, by the same rule."""
    sketch = Sketch(420, "Two indexes: walls and players",
                    "From above, z points up to the north; a square of the grid is 1 m wide. Walls are static, players move.")
    sketch.view(60, 390, 32, up=True)
    for i in range(11):
        sketch.path([(i, 0), (i, 10)], svg.GRID, width=1)
        sketch.path([(0, i), (10, i)], svg.GRID, width=1)
    walls = {"south wall": (0, 0, 10, 1), "north wall": (0, 9, 10, 10), "east wall": (9, 0, 10, 10)}
    for name, wall in walls.items():
        sketch.box(*wall, fill=STATIC, stroke=STATIC, opacity=0.5)
    sketch.label(4.5, 0.5, "south wall", anchor="middle", dy=5, halo=False)
    sketch.label(4.5, 9.5, "north wall", anchor="middle", dy=5, halo=False)
    sketch.label(10, 5, "east wall", dx=6, dy=5)
    for name, colour, position, velocity in (("red", svg.VERMILION, [2, 5], [3, 1]), ("blue", svg.BLUE, [6, 3], [-0.5, -1])):
        points = [tuple(position)]
        for _ in range(180):
            position = [p + v / 60 for p, v in zip(position, velocity)]
            for x0, z0, x1, z1 in walls.values():
                pushes = [(x1 - position[0] + 0.5, 0, 1), (position[0] + 0.5 - x0, 0, -1),
                          (z1 - position[1] + 0.5, 1, 1), (position[1] + 0.5 - z0, 1, -1)]
                depth, axis, sign = min(pushes)
                if depth < 0:
                    continue
                position[axis] += sign * depth
                velocity[axis] = 0 if velocity[axis] * sign < 0 else velocity[axis]
            points.append(tuple(position))
        sketch.path(points, colour)
        sketch.circle(*points[0], 0.5, stroke=colour, dashed=True)
        sketch.circle(*points[-1], 0.5, fill=colour, stroke=colour, opacity=0.5)
        sketch.label(*points[0], name, dx=20, dy=-8)
        sketch.label(*points[-1], f"({points[-1][0]:.2f}, {points[-1][1]:.2f})", anchor="end", dx=-20, dy=5)
    sketch.note(470, 100, "dashed: where a player begins", "filled: where it ends, at (x, z)")
    for x, z, name, dx, dy in ((15.6, 1, "x, east", 6, 5), (14, 2.6, "z, north", 0, -6)):
        sketch.arrow(14, 1, x, z, svg.GREY, width=1.5)
        sketch.label(x, z, name, anchor="middle" if dy < 0 else "start", dx=dx, dy=dy)
    return sketch.finish()


def sleepers():
    """The room of example_08_sleepers when the door is open."""
    sketch = Sketch(470, "The door is open",
                    "From above: boxes of 1.2 m, 1 m apart, so neighbours overlap. Those that touch the circle of 4 m around the door wake.").view(150, 80, 18)
    awake = 0
    for i in range(400):
        x, z = i % 20, i // 20
        dx, dz = max(0, abs(x + 1) - 0.6), max(0, abs(z - 10) - 0.6)
        near = dx * dx + dz * dz <= 16
        awake += near
        colour = AWAKE if near else RESTING
        sketch.box(x - 0.6, z - 0.6, x + 0.6, z + 0.6, fill=colour, stroke=colour, opacity=0.3, width=0.8)
    sketch.circle(-1, 10, 4, stroke=svg.INK, dashed=True)
    sketch.box(-1.6, 9.4, -0.4, 10.6, fill=svg.PURPLE, stroke=svg.PURPLE, opacity=0.7)
    sketch.label(-1.8, 10, "player", anchor="end", dy=5)
    sketch.legend([(f"{awake} monsters awake", AWAKE), (f"{400 - awake} asleep", RESTING)], y=462, x=140)
    return sketch.finish()


def rays():
    sketch = Sketch(380, "A ray and a camera in a tree", "Large boxes are nodes of the tree, small ones are values.")
    nodes = [((0, 0, 4, 3), [(0.4, 0.5), (2.6, 2.2), (3.1, 0.3)]), ((5, 0.5, 8.5, 4), [(5.4, 2.4), (7.3, 0.9), (7.6, 3)]),
             ((0.5, 4.2, 4, 7), [(1, 6), (3, 4.8)]), ((5, 4.8, 8.5, 7), [(5.6, 5.3), (7.2, 6.1)])]
    sketch.view(40, 90, 34)
    start, end = (-0.8, 1.4), (9.4, 3.1)
    for i, (node, values) in enumerate(nodes):
        hit = i < 2
        sketch.box(*node, stroke=NODE if hit else svg.GREY, dashed=not hit, width=2 if hit else 1)
        for k, (x, z) in enumerate(values):
            colour = AWAKE if (i, k) == (1, 0) else svg.SKY if hit else STATIC
            sketch.box(x, z, x + 0.6, z + 0.6, fill=colour, stroke=colour, opacity=0.6)
    sketch.arrow(*start, 5.4, 1.4 + 6.2 * 1.7 / 10.2, RAY)
    sketch.path([(5.4, 1.4 + 6.2 * 1.7 / 10.2), end], RAY, width=1, dashed=True)
    sketch.label(0, 3, "1st: no hit", dy=16)
    sketch.label(5, 0.5, "2nd: a hit", dy=-6)
    sketch.label(0.5, 7, "missed: nothing in it is tested", dy=16)
    sketch.view(440, 90, 34)
    eye, left, right = (-0.4, 3.6), (8.9, -0.4), (8.9, 4.5)
    sketch.polygon([eye, left, right], fill=svg.ORANGE, stroke=svg.ORANGE, opacity=0.12)
    inside = {1: "inside", 0: "partly", 3: "outside", 2: "outside"}
    kinds = [((1.4, 0.4, 4.4, 3.4), [(1.7, 0.8), (3.4, 2.4), (2.9, 1.5)]), ((5, 1.5, 8.4, 3.5), [(5.4, 2.6), (6.6, 1.8), (7.4, 2.7)]),
             ((0.5, 4.9, 4, 7), [(1, 6), (3, 5.3)]), ((5, 4.9, 8.4, 7), [(5.6, 5.4), (7.2, 6.1)])]
    for i, (node, values) in enumerate(kinds):
        out = inside[i] == "outside"
        sketch.box(*node, stroke=svg.GREY if out else NODE, dashed=out, width=1 if out else 2)
        for x, z in values:
            seen = i == 1 or (i == 0 and (x, z) != (1.7, 0.8))
            sketch.box(x, z, x + 0.6, z + 0.6, fill=AWAKE if seen else STATIC, stroke=AWAKE if seen else STATIC, opacity=0.6)
    sketch.point(*eye)
    sketch.label(1.4, 0.4, "partly inside: go on", dx=-60, dy=-6)
    sketch.label(8.4, 3.5, "inside: all seen", anchor="end", dy=15, halo=False)
    sketch.label(0.5, 7, "outside a plane: nothing is tested", dy=16)
    return sketch.finish()


def step():
    sketch = Sketch(250, "One step of a world", "Each stage reads what the stages before it have written.").view(20, 80, 1)
    stages = [("boxes", "of bodies", "that moved"), ("pairs", "boxes that", "overlap"), ("contacts", "points, depth", "and normal"),
              ("impulses", "so that nothing", "goes deeper"), ("motion", "new poses", "and velocities"), ("events", "began, ended,", "hit; sleep")]
    for i, (name, first, second) in enumerate(stages):
        x, colour = 130 * i, (svg.SKY, svg.SKY, svg.GREEN, svg.ORANGE, svg.ORANGE, svg.PURPLE)[i]
        sketch.box(x, 0, x + 112, 74, fill=colour, stroke=colour, opacity=0.25)
        sketch.text(x + 76, 103, name, anchor="middle", size=14, weight="bold")
        sketch.note(x + 76, 123, first, second, anchor="middle")
        if i:
            sketch.arrow(x - 18, 37, x - 1, 37, svg.GREY)
    for x0, x1, text in ((0, 242, "broad phase"), (260, 372, "narrow phase"), (390, 632, "solver, in sub-steps"), (650, 762, "told to you")):
        sketch.path([(x0, 90), (x0, 98), (x1, 98), (x1, 90)], svg.GREY, width=1.2)
        sketch.note(20 + (x0 + x1) / 2, 200, text, anchor="middle")
    return sketch.finish()


def queries():
    """The scene of example_13_world_queries, from the side."""
    sketch = Sketch(370, "Queries of a world",
                    "From the side; a crate is 1 m high, crates are bodies 1 to 5. Distances are measured to the exact shapes.")
    sketch.view(90, 320, 46, up=True)
    sketch.path([(-1.2, 0), (13.4, 0)], STATIC, width=4)
    for i in range(5):
        sketch.box(9.5, i, 10.5, i + 1, fill=STATIC, stroke=STATIC, opacity=0.5)
        sketch.label(10, i + 0.5, str(i + 1), anchor="middle", dy=5, halo=False)
    sketch.circle(0, 1.5, 0.3, fill=AWAKE, stroke=AWAKE)
    sketch.circle(9.2, 1.5, 0.3, stroke=AWAKE, dashed=True)
    sketch.arrow(0.3, 1.5, 9.5, 1.5, RAY)
    sketch.label(4.6, 1.5, "ray: 9.50 m; the ball itself: 9.20 m", anchor="middle", dy=-8)
    sketch.circle(10, 4.5, 1.2, stroke=svg.PURPLE, width=2)
    sketch.label(11.2, 4.5, "touches 2 crates", dx=8, dy=5)
    sketch.point(0, 3)
    sketch.label(0, 3, "nearest to this point:", dx=10, dy=-4)
    sketch.path([(0, 3), (0, 1.8)], svg.GREY, dashed=True)
    sketch.label(0, 2.4, "the ball (body 6), 1.20 m", dx=10, dy=5)
    sketch.path([(0, 3), (-0.6, 3), (-0.6, 0)], svg.GREY, dashed=True)
    sketch.label(-0.6, 0.5, "the ground (body 0), 3.00 m", dx=8, dy=5)
    return sketch.finish()


def planks():
    """The planks of example_15_push_and_spin, five times in a second."""
    sketch = Sketch(410, "The same push, in the middle and at the end",
                    "From above: the planks after 0, 0.25, 0.5, 0.75 and 1 s, the later the darker; arrows: where they are pushed or turned.")
    spin = 80 / (80 / 12 * (2**2 + 0.2**2))  # impulse times arm, divided by the moment of inertia
    for left, title, moves, spins in ((150, "push in the middle: moves", 1, 0), (400, "push at the end: moves and turns", 1, spin),
                                      (650, "torque: turns faster and faster", 0, -1)):
        sketch.view(left, 210, 95)
        for i in range(5):
            t = i / 4
            angle = spins * t if spins >= 0 else spin * t * t / 2  # a constant torque: the angle grows with the square
            sketch.polygon(turned(0, moves * t * 1.55, 1, 0.1, angle), fill=svg.BLUE, stroke=svg.BLUE, opacity=0.08 + 0.1 * i, width=1)
        sketch.note(left, 90, title, anchor="middle")
        if moves:
            at = 0.95 if spins else 0
            sketch.arrow(at, -0.38, at, -0.1, RAY)
        else:
            arc = [(0.45 * math.cos(a), 0.45 * math.sin(a)) for a in (-1.9 + 0.1 * k for k in range(14))]
            sketch.path(arc, RAY, width=2.5)
            sketch.arrow(*arc[-1], 0.45 * math.cos(-0.3), 0.45 * math.sin(-0.3), RAY)
    return sketch.finish()


SKETCHES = {"index": index, "two_phases": two_phases, "planes": planes, "leaves": leaves, "octree": octree, "atlas_tree": atlas_tree, "bounce": bounce,
            "players": players, "sleepers": sleepers, "rays": rays, "step": step,
            "queries": queries, "planks": planks}
