// A flange plate: 2 x 1 with rounded corners, a round opening and two bolt holes. The mesh is finer around the holes.
// plate.msh was made from this file by Gmsh 4.15.2:
//   gmsh -2 -format msh41 -o plate.msh plate.geo

length = 2;
width = 1;
corner = 0.15;   // radius of the corners
fine = 0.0145;   // edge length at the holes
coarse = 0.046;  // edge length far from them

Point(1) = {corner, 0, 0};
Point(2) = {length - corner, 0, 0};
Point(3) = {length, corner, 0};
Point(4) = {length, width - corner, 0};
Point(5) = {length - corner, width, 0};
Point(6) = {corner, width, 0};
Point(7) = {0, width - corner, 0};
Point(8) = {0, corner, 0};
Point(11) = {length - corner, corner, 0};
Point(12) = {length - corner, width - corner, 0};
Point(13) = {corner, width - corner, 0};
Point(14) = {corner, corner, 0};
Line(1) = {1, 2};
Circle(2) = {2, 11, 3};
Line(3) = {3, 4};
Circle(4) = {4, 12, 5};
Line(5) = {5, 6};
Circle(6) = {6, 13, 7};
Line(7) = {7, 8};
Circle(8) = {8, 14, 1};
Curve Loop(1) = {1 : 8};

// A hole as four quarters of a circle: centre (x, y), radius r; the curves are first, ..., first + 3.
Macro RoundHole
  Point(first) = {x, y, 0};
  Point(first + 1) = {x + r, y, 0};
  Point(first + 2) = {x, y + r, 0};
  Point(first + 3) = {x - r, y, 0};
  Point(first + 4) = {x, y - r, 0};
  Circle(first) = {first + 1, first, first + 2};
  Circle(first + 1) = {first + 2, first, first + 3};
  Circle(first + 2) = {first + 3, first, first + 4};
  Circle(first + 3) = {first + 4, first, first + 1};
  Curve Loop(first) = {first : first + 3};
Return

first = 20; x = length / 2; y = width / 2; r = 0.25; Call RoundHole;
first = 30; x = 0.3;        y = width / 2; r = 0.1;  Call RoundHole;
first = 40; x = length - x; y = width / 2; r = 0.1;  Call RoundHole;

Plane Surface(1) = {1, 20, 30, 40};

Physical Surface("plate", 1) = {1};
Physical Curve("outer boundary", 2) = {1 : 8};
Physical Curve("opening", 3) = {20 : 23};
Physical Curve("bolt holes", 4) = {30 : 33, 40 : 43};

Field[1] = Distance;
Field[1].CurvesList = {20 : 23, 30 : 33, 40 : 43};
Field[1].Sampling = 100;
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = coarse;
Field[2].DistMin = 0;
Field[2].DistMax = 0.25;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 6;  // Frontal-Delaunay
