// Compares two PNG files, decoded by the browser.

/** `different`: part of the pixels in which a colour differs by more than 32 of 255. Throws where the sizes differ. */
export async function compare_pictures(browser, one, two) {
  const page = await browser.newPage();
  try {
    return await page.evaluate(async (files) => {
      const pixels = [];
      for (const file of files) {
        const bytes = Uint8Array.from(atob(file), (c) => c.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
        const canvas = new OffscreenCanvas(image.width, image.height);
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        pixels.push(context.getImageData(0, 0, image.width, image.height));
      }
      const [a, b] = pixels;
      if (a.width !== b.width || a.height !== b.height) {
        throw new Error(`${a.width} x ${a.height} against ${b.width} x ${b.height} pixels`);
      }
      let different = 0;
      for (let k = 0; k < a.data.length; k += 4) {
        if ([0, 1, 2].some((c) => Math.abs(a.data[k + c] - b.data[k + c]) > 32)) ++different;
      }
      return { different: different / (a.data.length / 4) };
    }, [one, two].map((file) => Buffer.from(file).toString("base64")));
  } finally {
    await page.close();
  }
}
