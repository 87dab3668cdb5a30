# Sideband: API and worker in one image; the command decides which. The API asks for SIDEBAND_API_KEYS, because from
# inside a container it cannot tell who reaches its port.
FROM python:3.11-slim AS build
WORKDIR /src
RUN python -m venv /opt/sideband
# The locked versions first, in a layer of their own: they change seldom, the code often.
COPY requirements-server.lock ./
RUN /opt/sideband/bin/pip install --no-cache-dir -r requirements-server.lock
COPY pyproject.toml README.md LICENSE THIRD_PARTY_NOTICES.md ./
COPY sim sim
COPY signals signals
COPY reconcile reconcile
COPY sideband_datasets sideband_datasets
COPY learn learn
COPY jobs jobs
COPY store store
COPY workers workers
COPY app app
COPY sideband_client sideband_client
RUN /opt/sideband/bin/pip install --no-cache-dir --no-deps . && /opt/sideband/bin/pip check

FROM python:3.11-slim
RUN useradd --system --uid 10001 --create-home --home-dir /home/sideband sideband \
    && install -d -o sideband -g sideband /data /var/cache/sideband
COPY --from=build /opt/sideband /opt/sideband
ENV PATH=/opt/sideband/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    SIDEBAND_CACHE=/var/cache/sideband \
    MPLCONFIGDIR=/var/cache/sideband/matplotlib \
    OMP_NUM_THREADS=1 \
    OPENBLAS_NUM_THREADS=1 \
    SIDEBAND_DATA_DIR=/data \
    SIDEBAND_PAGES_DIR=/opt/sideband/share/physics \
    SIDEBAND_HOST=0.0.0.0
USER sideband
WORKDIR /home/sideband
COPY docs/physics /opt/sideband/share/physics
# Compile the kernels while the image is built: the first job must not wait for it. Another kind of CPU compiles again.
RUN python -m workers.warm
VOLUME /data
EXPOSE 8000
STOPSIGNAL SIGTERM
HEALTHCHECK --interval=10s --timeout=5s --start-period=30s --retries=3 \
    CMD ["python", "-c", "import urllib.request as r; r.urlopen('http://127.0.0.1:8000/healthz', timeout=4)"]
CMD ["uvicorn", "--factory", "app.wiring:application", "--host", "0.0.0.0", "--port", "8000", "--no-server-header"]
