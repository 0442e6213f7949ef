MODULE M
  PROC main()
    Set do1;
