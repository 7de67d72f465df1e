// Drawing.

/** Uploads the mesh. Returns functions that draw it and that find what is at a pixel. */
function makeRenderer(gl, mesh) {
  const colorProgram = programPair(gl, VERTEX_SHADER, COLOR_SHADER);
  const pickProgram = programPair(gl, VERTEX_SHADER, PICK_SHADER);
  const lineProgram = programPair(gl, LINE_VERTEX_SHADER, LINE_SHADER);
  const triangles = uploadTriangles(gl, mesh);
  const ofSides = (data) => makeTexture(gl, gl.RGBA32F, textureRows(mesh.header.sides), gl.RGBA, gl.FLOAT, data);
  let textures = [mesh.light, mesh.surface, mesh.source].map(ofSides);
  const target = makePickTarget(gl);
  let lines = null;

  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);
  gl.depthFunc(gl.LEQUAL);
  gl.pixelStorei(gl.PACK_ALIGNMENT, 4);

  /** Uploads the light again, after it has changed. */
  function updateLight() {
    textures.forEach((texture) => gl.deleteTexture(texture));
    textures = [mesh.light, mesh.surface, mesh.source].map(ofSides);
    gl.bindBuffer(gl.ARRAY_BUFFER, triangles.codes);
    gl.bufferData(gl.ARRAY_BUFFER, alignedCodes(mesh.codes), gl.STATIC_DRAW);
  }

  function drawTriangles({ program, at }, view) {
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.clip, false, view.clip);
    const { low, step } = mesh.header.logs.irradiance;
    gl.uniform2f(at.codes, low, step);
    if (view.sectioned) gl.uniform4fv(at.section, view.section);
    gl.bindVertexArray(triangles.vertices);
    gl.drawElements(gl.TRIANGLES, mesh.index.length, gl.UNSIGNED_INT, 0);
  }

  function draw(view, look) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(...look.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const { program, at } = colorProgram(view.sectioned);
    gl.useProgram(program);
    bindTextures(gl, textures, [at.sideLight, at.sideSurface, at.sideSource]);
    gl.uniform1i(at.mode, look.mode);
    gl.uniform1i(at.flatValues, look.flat ? 1 : 0);
    gl.uniform1i(at.logarithmic, look.logarithmic ? 1 : 0);
    gl.uniform2fv(at.limits, look.limits);
    gl.uniform1f(at.exposure, look.exposure);
    drawTriangles(colorProgram(view.sectioned), view);
    if (look.lines) drawLines(view, look);
  }

  function drawLines(view, look) {
    lines ??= uploadLines(gl, mesh);
    const { program, at } = lineProgram(view.sectioned);
    gl.useProgram(program);
    bindTextures(gl, [lines.positions, lines.edges], [at.positions, at.edges]);
    gl.uniformMatrix4fv(at.clip, false, view.clip);
    if (view.sectioned) gl.uniform4fv(at.section, view.section);
    gl.uniform4fv(at.eye, view.eye);
    gl.uniform1f(at.nearer, view.eye[3] > 0 ? 1e-3 : 5e-4 * mesh.size);
    gl.uniform4fv(at.ink, look.ink);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthFunc(gl.LESS);
    gl.bindVertexArray(lines.vertices);
    gl.drawArrays(gl.LINES, 0, 2 * lines.count);
    gl.depthFunc(gl.LEQUAL);
    gl.disable(gl.BLEND);
  }

  /** Finds the side and the position at a pixel: only this pixel is drawn. */
  function pick(view, x, y) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(-x, -(gl.drawingBufferHeight - 1 - y), gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    drawTriangles(pickProgram(view.sectioned), view);
    const found = new Uint32Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, found);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    if (found[0] === 0) return null;
    const place = new Float32Array(found.buffer, 4, 3);
    return { side: found[0] - 1, point: add(mesh.middle, place) };
  }

  return { draw, pick, updateLight };
}

function uploadTriangles(gl, mesh) {
  const vertices = gl.createVertexArray();
  gl.bindVertexArray(vertices);
  const upload = (kind, data) => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(kind, buffer);
    gl.bufferData(kind, data, gl.STATIC_DRAW);
    return buffer;
  };
  upload(gl.ARRAY_BUFFER, mesh.position);
  gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12, 0);
  const codes = upload(gl.ARRAY_BUFFER, alignedCodes(mesh.codes));
  gl.vertexAttribPointer(1, 3, gl.UNSIGNED_SHORT, false, 8, 0);
  upload(gl.ARRAY_BUFFER, mesh.owner);
  gl.vertexAttribIPointer(2, 1, gl.UNSIGNED_INT, 4, 0);
  [0, 1, 2].forEach((location) => gl.enableVertexAttribArray(location));
  upload(gl.ELEMENT_ARRAY_BUFFER, mesh.index);
  gl.bindVertexArray(null);
  return { vertices, codes };
}

/** Puts a fourth number after each three codes: vertices have to begin at multiples of four bytes. */
function alignedCodes(codes) {
  const aligned = new Uint16Array((codes.length / 3) * 4);
  for (let i = 0, j = 0; i < codes.length; i += 3, j += 4) {
    aligned[j] = codes[i];
    aligned[j + 1] = codes[i + 1];
    aligned[j + 2] = codes[i + 2];
  }
  return aligned;
}

function makeTexture(gl, inside, rows, format, type, data) {
  if (rows > gl.getParameter(gl.MAX_TEXTURE_SIZE)) throw new Error('The scene has more patches than this graphics system can show.');
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.texImage2D(gl.TEXTURE_2D, 0, inside, TEXTURE_WIDTH, rows, 0, format, type, data);
  return texture;
}

function bindTextures(gl, textures, locations) {
  textures.forEach((texture, unitNumber) => {
    gl.activeTexture(gl.TEXTURE0 + unitNumber);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.uniform1i(locations[unitNumber], unitNumber);
  });
}

/** Makes a framebuffer of one pixel that takes four integers. */
function makePickTarget(gl) {
  const target = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  for (const [place, format] of [[gl.COLOR_ATTACHMENT0, gl.RGBA32UI], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]]) {
    const buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
  }
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return target;
}

/** Finds and uploads the outlines of patches. */
function uploadLines(gl, mesh) {
  const edges = findOutlines(mesh);
  const count = edges.length / 3;
  const padded = (Type, data, number) => joined(Type, data, new Type(3 * (TEXTURE_WIDTH * textureRows(number) - number)));
  const vertexCount = mesh.position.length / 3;
  return {
    count,
    vertices: gl.createVertexArray(),
    positions: makeTexture(gl, gl.RGB32F, textureRows(vertexCount), gl.RGB, gl.FLOAT, padded(Float32Array, mesh.position, vertexCount)),
    edges: makeTexture(gl, gl.RGB32UI, textureRows(count), gl.RGB_INTEGER, gl.UNSIGNED_INT, padded(Uint32Array, edges, count)),
  };
}
