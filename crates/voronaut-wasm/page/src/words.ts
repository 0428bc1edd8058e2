// The command line and the Python call that make the mesh of the page.

export interface Job { domain: string; metric: string; vertices: number; cells: boolean }

/** A word as shells read it. */
const quoted = (word: string) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
const python = (word: string) => JSON.stringify(word);

/** What files that are made are called, without an ending. */
export function stem(domain: string) {
  const file = domain.match(/^(.+)\.\w+$/)?.[1];
  return (file ?? domain.split(":")[0]).replace(/[^\w.-]+/g, "-") || "mesh";
}

export const commandLine = ({ domain, metric, vertices }: Job) =>
  `voronaut mesh ${quoted(domain)} --metric ${quoted(metric)} -n ${vertices} -o ${stem(domain)}-${vertices}.mesh`;

export const pythonCall = ({ domain, metric, vertices }: Job) =>
  `import voronaut\nmesh = voronaut.mesh(${python(domain)}, ${python(metric)}, n=${vertices})`;
