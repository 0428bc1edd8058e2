// What there is to begin with: the meshes of the docs and of the report that voronaut is about.

export interface Example { name: string; domain: string; metric: string; vertices: number; cells?: boolean }

const SHOCK = "rect:-1,-1,1,1", SWIRL = "rect:-2,-2,2,2";

/** Files that come with the page, by the names of their elements. */
export const FILES = ["aegean.geojson", "spot.obj"];

export const EXAMPLES: Example[] = [
  { name: "Shock, mild (RR-9103)", domain: SHOCK, metric: "shock:phi=1,lambda=0.6", vertices: 2000 },
  { name: "Shock, phi = 10 (RR-9103)", domain: SHOCK, metric: "shock:phi=10,lambda=0.6", vertices: 2000 },
  { name: "Shock, hard (RR-9103)", domain: SHOCK, metric: "shock:phi=10,lambda=0.06", vertices: 2000 },
  { name: "Swirl (RR-9103)", domain: SWIRL, metric: "swirl", vertices: 2000 },
  { name: "Swirl as printed (RR-9103)", domain: SWIRL, metric: "swirl:field=printed", vertices: 2000 },
  { name: "Swirl of 320 cells (RR-9103)", domain: SWIRL, metric: "swirl", vertices: 320, cells: true },
  { name: "Chair, shock (RR-9103)", domain: "chair", metric: "shock", vertices: 1020 },
  { name: "Chair, curvature", domain: "chair", metric: "curvature", vertices: 1020 },
  { name: "Sphere, shock (RR-9103)", domain: "sphere:1", metric: "shock", vertices: 1020 },
  { name: "Torus, curvature", domain: "torus:2,0.7", metric: "curvature", vertices: 1500 },
  { name: "SPOT, curvature", domain: "spot.obj", metric: "curvature", vertices: 1000 },
  { name: "The Aegean", domain: "aegean.geojson", metric: "boundary:h0=0.5,growth=1.2,aspect=4,h_max=30", vertices: 8000 },
  { name: "A layer, by a formula", domain: SHOCK, metric: "formula:1/(0.01 + 0.2*abs(y))^2; 0; 25", vertices: 1500 },
  { name: "A front, for least error", domain: "rect:0,0,1,1", metric: "hessian:tanh(60*(x + y - 1.1))", vertices: 2000 },
];

/** Metrics to pick from, in the plane and on surfaces. */
export const METRICS = {
  plane: [
    "uniform", "shock:phi=1,lambda=0.6", "shock:phi=10,lambda=0.6", "swirl", "swirl:field=printed", "boundary:h0=0.02,growth=1.2,aspect=4,h_max=0.5",
    "formula:1/(0.01 + 0.2*abs(y))^2; 0; 25", "hessian:tanh(60*(x + y - 1.1))"],
  surface: ["curvature", "uniform", "shock", "formula:1; 0; 1; 0; 0; 1/(0.05 + z^2)"],
};
