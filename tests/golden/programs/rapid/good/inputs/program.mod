MODULE M
  PROC main()
    IF di1=1 Set do1;
    IF di2=1 Set do2;
    IF di2=0 Set do3;
    IF DI_1<>0 AND TestDI(di1) Set do4;
    IF do4=high Set do5;
    IF do6=low Set do6;
  ENDPROC
ENDMODULE
