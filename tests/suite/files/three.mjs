// Shows the card of a leaf in three.js in a headless Chromium, as GLB and as OBJ, from either side.
//
//   node three.mjs NODE_MODULES CHROMIUM LEAF_FOLDER STEM OUT_FOLDER
//
// Writes OUT_FOLDER/{glb,obj}-{front,back}.png and prints what the loaders made of the files, as JSON.
import { createServer } from 'node:http';
import { readFile, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';

const [modules, chromium, leaf, stem, out] = process.argv.slice(2);
const puppeteer = createRequire(path.join(modules, 'x.js'))('puppeteer-core');

const page = `<!doctype html><meta charset="utf-8">
<script type="importmap">{"imports": {
  "three": "/modules/three/build/three.module.js", "three/addons/": "/modules/three/examples/jsm/"
}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MTLLoader } from 'three/addons/loaders/MTLLoader.js';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';

const SIZE = 512;
const renderer = new THREE.WebGLRenderer({ alpha: true, antialias: true, preserveDrawingBuffer: true });
renderer.setSize(SIZE, SIZE);
renderer.setClearColor(0, 0);
document.body.append(renderer.domElement);

const materials = (object) => {
  const found = [];
  object.traverse((part) => {
    for (const m of part.isMesh ? [part.material].flat() : []) found.push({
      name: m.name, type: m.type, transparent: m.transparent, alphaTest: m.alphaTest,
      metalness: m.metalness ?? null, doubleSided: m.side === THREE.DoubleSide,
      map: m.map?.image?.width ?? null, normal: m.normalMap?.image?.width ?? null,
      alphaMap: m.alphaMap?.image?.width ?? null, bump: !!m.bumpMap,
    });
  });
  return found;
};

const loaders = {
  glb: async () => (await new GLTFLoader().loadAsync('/leaf/${stem}.glb')).scene,
  obj: async () => {
    const creator = await new MTLLoader().setPath('/leaf/').loadAsync('${stem}.mtl');
    creator.preload();
    return new OBJLoader().setMaterials(creator).setPath('/leaf/').loadAsync('${stem}.obj');
  },
};
window.show = async (kind) => {
  const pending = new Promise((done) => { THREE.DefaultLoadingManager.onLoad = done; });
  const object = await loaders[kind]();
  await pending;
  const box = new THREE.Box3().setFromObject(object);
  const [middle, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3())];
  const half = Math.max(size.x, size.y) / 2;
  const scene = new THREE.Scene();
  scene.add(object, new THREE.AmbientLight(0xffffff, 1.5));
  const pictures = {};
  for (const [side, sign] of [['front', 1], ['back', -1]]) {
    const camera = new THREE.OrthographicCamera(-half, half, half, -half, 0.01, 10);
    camera.position.set(middle.x, middle.y, middle.z + sign);
    camera.lookAt(middle);
    const sun = new THREE.DirectionalLight(0xffffff, 1.5);
    sun.position.set(middle.x - sign, middle.y + 1, middle.z + 1.4 * sign);
    sun.target.position.copy(middle);
    scene.add(sun, sun.target);
    renderer.render(scene, camera);
    pictures[side] = renderer.domElement.toDataURL('image/png');
    scene.remove(sun);
  }
  return { pictures, size: size.toArray(), materials: materials(object) };
};
window.ready = true;
</script>`;

const server = createServer(async (request, response) => {
  const { pathname } = new URL(request.url, 'http://x');
  const types = { '.js': 'text/javascript', '.png': 'image/png' };
  try {
    const [, root, ...rest] = decodeURIComponent(pathname).split('/');
    const folder = { modules, leaf }[root];
    const body = folder ? await readFile(path.join(folder, ...rest)) : page;
    response.setHeader('content-type', types[path.extname(pathname)] ?? 'text/html');
    response.end(body);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((listening) => server.listen(0, '127.0.0.1', listening));

const browser = await puppeteer.launch({
  executablePath: chromium,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
const report = { messages: [] };
try {
  const tab = await browser.newPage();
  tab.on('console', (message) => {
    if (['warn', 'error'].includes(message.type())) report.messages.push(message.text());
  });
  tab.on('pageerror', (error) => report.messages.push(String(error)));
  await tab.goto(`http://127.0.0.1:${server.address().port}/`);
  await tab.waitForFunction('window.ready', { timeout: 60000 });
  for (const kind of ['glb', 'obj']) {
    const { pictures, ...rest } = await tab.evaluate((kind) => window.show(kind), kind);
    report[kind] = rest;
    for (const [side, url] of Object.entries(pictures)) {
      await writeFile(path.join(out, `${kind}-${side}.png`), Buffer.from(url.split(',')[1], 'base64'));
    }
  }
} finally {
  await browser.close();
  server.close();
}
console.log(JSON.stringify(report));
