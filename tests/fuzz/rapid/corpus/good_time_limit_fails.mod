MODULE M
  PROC main()
    WaitDI di7,1\MaxTime:=1.5;
    Set do1;
  ENDPROC
ENDMODULE
